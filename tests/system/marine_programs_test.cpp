// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "bridges/lcm/lcm_listener.hpp"
#include "tests/system/shoal_program.hpp"

namespace {

using system_test::built;
using system_test::Ended;
using system_test::own_url;
using system_test::run_shoal;
using system_test::ScratchFolder;
using system_test::source;
using system_test::text_of_file;
using testing::HasSubstr;

Ended run(const std::string& name, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), built(name));
  system_test::Program program(std::move(arguments));
  const int exit_code = program.wait();
  return {exit_code, program.output(), program.errors()};
}

TEST(MarinePrograms, HelpShowsExamplesAndExitCodes) {
  for (const char* name : {"shoal-coop-craft", "shoal-coop-auv", "shoal-coop-rover", "shoal-coop-station"}) {
    const Ended ended = run(name, {"--help"});
    EXPECT_EQ(ended.exit_code, 0) << name;
    EXPECT_THAT(ended.output, HasSubstr("Example"));
    EXPECT_THAT(ended.output, HasSubstr("Exit codes:"));
  }
}

struct Mistake {
  const char* program;
  std::vector<std::string> arguments;
  const char* says;
};

TEST(MarinePrograms, WrongUsageIsExitCodeTwoAndSaysWhat) {
  const std::vector<Mistake> mistakes = {
      {"shoal-coop-craft", {}, "--name is required"},
      {"shoal-coop-craft", {"--name", "b"}, "the behaviour 'route' needs --route"},
      {"shoal-coop-craft", {"--name", "b", "--route", "1,x"}, "shoal-coop-craft: --route: 'x' is not a number"},
      {"shoal-coop-craft", {"--name", "b", "--route", "1,1", "--slot", "2/2"}, "0 <= I < N, got 2/2"},
      {"shoal-coop-craft", {"--name", "b", "--route", "1,1", "--slot", "0/2", "--guard-s", "10"}, "guard time shorter"},
      {"shoal-coop-craft", {"--name", "b", "--route", "1,1", "--slot", "0/2", "--random-s", "5"}, "give one"},
      {"shoal-coop-auv", {"--name", "a", "--behaviour", "orbit:1"}, "unknown behaviour 'orbit:1'"},
      {"shoal-coop-auv", {"--name", "a", "--behaviour", "circle:1,2"}, "circle:X,Y,RADIUS"},
      {"shoal-coop-auv", {"--name", "a", "--route", "1,1", "--states", "3"}, "--states"},
      {"shoal-coop-auv", {"--name", "a", "--route", "1,1", "--start", "1"}, "--start: '1' is not of the form x,y"},
      {"shoal-coop-auv", {"--name", "a", "--route", "1,1", "--steer", "luck"}, "--steer"},
      {"shoal-coop-auv", {"--name", "a", "--route", "1,1", "--depth", "-1"}, "--depth"},
      {"shoal-coop-auv",
       {"--name", "a", "--route", "1,1", "--depth", "nan"},
       "--depth: must be from 0 to 10000, got 'nan'"},
      {"shoal-coop-auv",
       {"--name", "a", "--route", "1,1", "--heading-noise", "nan"},
       "must be from 0 to 10, got 'nan'"},
      {"shoal-coop-craft", {"--name", "b", "--route", "1,1", "--speed", "nan"}, "must be from 0.05 to 10, got 'nan'"},
      {"shoal-coop-craft",
       {"--name", "b", "--route", "1,1", "--join-timeout", "nan"},
       "must be from 0.1 to 3600, got 'nan'"},
      {"shoal-coop-craft", {"--name", "b", "--behaviour", "follow:b,0,10"}, "'b' cannot follow itself"},
      {"shoal-coop-auv", {"--name", "a", "--route", "1,1", "--hold-radius", "0"}, "--hold-radius"},
      {"shoal-coop-station",
       {"--name", "s", "--to", "0", "--orders", "1:2,3,4", "--speed", "nan"},
       "must be from 0.05 to 10"},
      {"shoal-coop-station", {"--name", "s", "--to", "0"}, "--orders is required"},
      {"shoal-coop-station", {"--name", "s", "--to", "0", "--orders", "1:2,3,4"}, "give --slot or --random-s"},
      {"shoal-coop-station", {"--name", "s", "--to", "0", "--orders", "1;2", "--slot", "0/1"}, "TIME:X,Y,DEPTH"},
      {"shoal-coop-station",
       {"--name", "s", "--to", "0", "--orders", "2:0,0,1;1:0,0,1", "--slot", "0/1"},
       "must not go back"},
  };
  for (const Mistake& mistake : mistakes) {
    const Ended ended = run(mistake.program, mistake.arguments);
    EXPECT_EQ(ended.exit_code, 2) << mistake.says;
    EXPECT_THAT(ended.errors, HasSubstr(mistake.says));
  }
}

TEST(MarinePrograms, WithoutASimulatorIsExitCodeFour) {
  for (const char* name : {"shoal-coop-craft", "shoal-coop-auv"}) {
    const Ended ended = run(name, {"--name", "a", "--route", "1,1", "--slot", "0/3", "--slot-s", "5", "--join-timeout",
                                   "0.2", "--lcm-url", own_url(3)});
    EXPECT_EQ(ended.exit_code, 4) << name;
    EXPECT_THAT(ended.errors, HasSubstr("no simulator answered 'a' in time"));
  }
}

TEST(MarinePrograms, SignalWhileItWaitsForTheSimulatorIsSaid) {
  system_test::Program program({built("shoal-coop-auv"), "--name", "a", "--route", "1,1", "--lcm-url", own_url(3)});
  // Its requests to join say that it waits.
  bridges::LcmListener requests(own_url(3));
  requests.listen("sim.control");
  ASSERT_TRUE(requests.next(system_test::patience));
  program.send_signal(SIGTERM);
  EXPECT_EQ(program.wait(), 143);
  EXPECT_THAT(program.errors(), HasSubstr("'a' was stopped while it waited for a simulator"));
}

TEST(CoopRelay, OrderComesToTheAuvByTheRelayAndNotWithoutIt) {
  const ScratchFolder folder;
  for (const bool relay : {true, false}) {
    const std::string results = folder.file(relay ? "relay" : "no_relay");
    std::vector<std::string> arguments = {
        "run",       source("worlds/coop_relay.yaml"), "--launch",  "--duration", "240",
        "--lcm-url", own_url(relay ? 4 : 5),           "--results", results,      "--no-pictures"};
    if (!relay) arguments.insert(arguments.end(), {"--set", "vehicles.boat.devices.gateway.only_prefix=nothing"});
    const Ended ended = run_shoal(arguments);
    EXPECT_EQ(ended.exit_code, 1) << ended.errors;  // too short for its rules
    // The order is said at 125 s for the first time, and a turn is lost in 36 of 100 cases.
    const std::string obeyed = relay ? "station: 1 of 1 orders obeyed" : "station: 0 of 1 orders obeyed";
    EXPECT_THAT(text_of_file(results + "/station.log"), HasSubstr(obeyed));
    EXPECT_THAT(text_of_file(results + "/auv.log"), HasSubstr(relay ? "1 orders obeyed" : "0 orders obeyed"));
  }
}

TEST(CoopRelay, ARefusedOrderComesBackToTheStationByTheRelay) {
  const ScratchFolder folder;
  // The first order is for 15 m.
  const std::string command =
      "processes.auv.command=[shoal-coop-auv, --name, auv, --id, '0', --obey, --behaviour, 'circle:0,0,40', --speed, "
      "'1.5', --depth, '10', --states, '6', --sound-speed, '1505', --slot, 2/3, --slot-s, '5', --order-depth-max, "
      "'12']";
  const Ended ended = run_shoal({"run", source("worlds/coop_relay.yaml"), "--launch", "--duration", "300", "--lcm-url",
                                 own_url(6), "--results", folder.file("out"), "--no-pictures", "--set", command});
  EXPECT_EQ(ended.exit_code, 1) << ended.errors;  // its rules fail
  const std::string said = text_of_file(folder.file("out/station.log"));
  EXPECT_THAT(said, HasSubstr("station: order 1 was refused: too deep, 15 m\n"));
  EXPECT_THAT(said, HasSubstr("station: 0 of 1 orders obeyed, 1 refused"));
  EXPECT_THAT(text_of_file(folder.file("out/auv.log")), HasSubstr("0 orders obeyed, 1 refused"));
}

/// The summary of the first minutes of a world with its programs.
nlohmann::json summary_of(const std::string& world, const std::string& results, int url, const std::string& threads) {
  const Ended ended =
      run_shoal({"run", source(world), "--launch", "--duration", "300", "--threads", threads, "--speed",
                 threads == "1" ? "max" : "200", "--lcm-url", own_url(url), "--results", results, "--no-pictures"});
  EXPECT_EQ(ended.exit_code, 1) << ended.errors;  // too short for its rules
  return nlohmann::json::parse(text_of_file(results + "/summary.json"));
}

TEST(CooperativeNavigation, IsTheSameRunAtAnySpeedAndWithAnyThreads) {
  const ScratchFolder folder;
  for (const char* world : {"worlds/coop_underwater.yaml", "worlds/coop_one_beacon.yaml"}) {
    const auto first = summary_of(world, folder.file("first"), 6, "1");
    const auto second = summary_of(world, folder.file("second"), 7, "3");
    EXPECT_EQ(first["run_hash"], second["run_hash"]) << world;
    EXPECT_EQ(first["metrics"], second["metrics"]) << world;
    EXPECT_EQ(first["bad_messages"], 0) << world;
    EXPECT_GE(first["metrics"]["link.received"], 20) << world;
    // With GPS of 1 m before the dive and ranges of decimetres after it.
    EXPECT_LT(first["metrics"]["cooperative.rms_m"], 6) << world;
    EXPECT_GT(first["acoustics"]["sent"], 20) << world;
  }
}

}  // namespace
