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
  for (const char* name :
       {"shoal-coop-craft", "shoal-coop-auv", "shoal-coop-rover", "shoal-coop-station", "shoal-ranger"}) {
    const Ended ended = run(name, {"--help"});
    EXPECT_EQ(ended.exit_code, 0) << name;
    EXPECT_THAT(ended.output, HasSubstr("Example"));
    EXPECT_THAT(ended.output, HasSubstr("Exit codes:"));
  }
}

struct Mistake {
  const char* program;
  std::vector<std::string> arguments;
  const char* reports;
};

TEST(MarinePrograms, WrongUsageIsExitCodeTwoAndSaysWhat) {
  const std::vector<Mistake> mistakes = {
      {"shoal-coop-craft", {}, "--name is required"},
      {"shoal-coop-craft", {"--name", "b"}, "needs --waypoints-m, --circle-m, --zigzag-m, --follow or --leader"},
      {"shoal-coop-craft",
       {"--name", "b", "--waypoints-m", "[[1,x]]"},
       "shoal-coop-craft: --waypoints-m: item 2 of 'waypoints_m[1]' must be a number, got 'x'"},
      {"shoal-coop-craft",
       {"--name", "b", "--waypoints-m", "[[1, 2], [3]]"},
       "shoal-coop-craft: --waypoints-m: 'waypoints_m[2]' must be 2 numbers, got 1"},
      {"shoal-coop-craft", {"--name", "b", "--waypoints-m", "[]"}, "waypoint"},
      {"shoal-coop-craft", {"--name", "b", "--waypoints-m", "[[1,1]]", "--slot", "0"}, "--slot needs --slots"},
      {"shoal-coop-craft",
       {"--name", "b", "--waypoints-m", "[[1,1]]", "--slot", "2", "--slots", "2"},
       "0 <= I < N, got 2/2"},
      {"shoal-coop-craft",
       {"--name", "b", "--waypoints-m", "[[1,1]]", "--slot", "0", "--slots", "2", "--guard-s", "10"},
       "guard time shorter"},
      {"shoal-coop-craft",
       {"--name", "b", "--waypoints-m", "[[1,1]]", "--slot", "0", "--slots", "2", "--random-s", "5"},
       "cannot be combined with --"},
      {"shoal-coop-craft",
       {"--name", "b", "--waypoints-m", "[[1,1]]", "--circle-m", "[1,1,5]"},
       "cannot be combined with --"},
      {"shoal-coop-auv", {"--name", "a", "--orbit", "1"}, "unknown option '--orbit'"},
      {"shoal-coop-auv", {"--name", "a", "--circle-m", "[1,2]"}, "--circle-m: 'circle_m' must be 3 numbers, got 2"},
      {"shoal-coop-auv", {"--name", "a", "--circle-m", "[1,2,0]"}, "the radius of a circle must be > 0"},
      {"shoal-coop-auv", {"--name", "a", "--waypoints-m", "[[1,1]]", "--states", "3"}, "--states"},
      {"shoal-coop-auv",
       {"--name", "a", "--waypoints-m", "[[1,1]]", "--start-m", "1"},
       "--start-m: 'start_m' must be a list of 2 numbers, got '1'"},
      {"shoal-coop-auv", {"--name", "a", "--waypoints-m", "[[1,1]]", "--steer", "luck"}, "--steer"},
      {"shoal-coop-auv", {"--name", "a", "--waypoints-m", "[[1,1]]", "--depth-m", "-1"}, "--depth-m"},
      {"shoal-coop-auv",
       {"--name", "a", "--waypoints-m", "[[1,1]]", "--depth-m", "nan"},
       "--depth-m: must be from 0 to 10000, got 'nan'"},
      {"shoal-coop-auv",
       {"--name", "a", "--waypoints-m", "[[1,1]]", "--heading-noise-radprtHz", "nan"},
       "must be from 0 to 10, got 'nan'"},
      {"shoal-coop-craft",
       {"--name", "b", "--waypoints-m", "[[1,1]]", "--speed-mps", "nan"},
       "must be from 0.05 to 10, got 'nan'"},
      {"shoal-coop-craft",
       {"--name", "b", "--waypoints-m", "[[1,1]]", "--join-timeout-s", "nan"},
       "must be from 0.1 to 3600, got 'nan'"},
      {"shoal-coop-craft", {"--name", "b", "--follow", "b", "--follow-offset-m", "[0,10]"}, "'b' cannot follow itself"},
      {"shoal-coop-craft", {"--name", "b", "--leader", "b"}, "'b' cannot lead itself"},
      {"shoal-coop-craft",
       {"--name", "b", "--leader", "a", "--formation", "offset"},
       "the formation 'offset' needs formation_offset_m"},
      {"shoal-coop-craft",
       {"--name", "b", "--leader", "a", "--formation-offset-m", "[0,10]"},
       "formation_offset_m is for the formation 'offset', not 'vee'"},
      {"shoal-coop-craft", {"--name", "b", "--leader", "a", "--formation", "ring"}, "--formation"},
      {"shoal-coop-craft", {"--name", "b", "--waypoints-m", "[[1,1]]", "--avoid", "luck"}, "--avoid"},
      {"shoal-coop-craft", {"--name", "b", "--waypoints-m", "[[1,1]]", "--formation", "vee"}, "needs --leader"},
      {"shoal-ranger", {"--name", "r"}, "is required"},
      {"shoal-coop-craft", {"--name", "b", "--follow", "a"}, "--follow needs --follow-offset-m"},
      {"shoal-coop-auv", {"--name", "a", "--waypoints-m", "[[1,1]]", "--hold-radius-m", "0"}, "--hold-radius-m"},
      {"shoal-coop-auv",
       {"--name", "a", "--waypoints-m", "[[1,1]]", "--describe"},
       "--describe takes no other options"},
      {"shoal-coop-station",
       {"--name", "s", "--to", "0", "--orders", "[[1,2,3,4]]", "--speed-mps", "nan"},
       "must be from 0.05 to 10"},
      {"shoal-coop-station", {"--name", "s", "--to", "0"}, "--orders is required"},
      {"shoal-coop-station", {"--name", "s", "--to", "0", "--orders", "[[1,2,3,4]]"}, "needs --slot or --random-s"},
      {"shoal-coop-station",
       {"--name", "s", "--to", "0", "--orders", "[[1,2]]", "--slot", "0", "--slots", "1"},
       "--orders: 'orders[1]' must be 4 to 5 numbers, got 2"},
      {"shoal-coop-station",
       {"--name", "s", "--to", "0", "--orders", "[[2,0,0,1],[1,0,0,1]]", "--slot", "0", "--slots", "1"},
       "must not decrease"},
  };
  for (const Mistake& mistake : mistakes) {
    const Ended ended = run(mistake.program, mistake.arguments);
    EXPECT_EQ(ended.exit_code, 2) << mistake.reports;
    EXPECT_THAT(ended.errors, HasSubstr(mistake.reports));
  }
}

TEST(MarinePrograms, WithoutASimulatorIsExitCodeFour) {
  for (const char* name : {"shoal-coop-craft", "shoal-coop-auv"}) {
    const Ended ended = run(name, {"--name", "a", "--waypoints-m", "[[1,1]]", "--slot", "0", "--slots", "3", "--slot-s",
                                   "5", "--join-timeout-s", "0.2", "--lcm-url", own_url(3)});
    EXPECT_EQ(ended.exit_code, 4) << name;
    EXPECT_THAT(ended.errors, HasSubstr("no simulator answered 'a' in time"));
  }
}

TEST(MarinePrograms, SignalWhileItWaitsForTheSimulatorIsSaid) {
  system_test::Program program(
      {built("shoal-coop-auv"), "--name", "a", "--waypoints-m", "[[1,1]]", "--lcm-url", own_url(3)});
  // Its requests to join say that it waits.
  bridges::LcmListener requests(own_url(3));
  requests.listen("sim.control");
  ASSERT_TRUE(requests.next(system_test::timeout));
  program.send_signal(SIGTERM);
  EXPECT_EQ(program.wait(), 143);
  EXPECT_THAT(program.errors(), HasSubstr("'a' was stopped while it waited for a simulator"));
}

TEST(CoopRelay, OrderReachesTheAuvByTheRelayAndNotWithoutIt) {
  const ScratchFolder folder;
  for (const bool relay : {true, false}) {
    const std::string results = folder.file(relay ? "relay" : "no_relay");
    std::vector<std::string> arguments = {
        "run",       source("worlds/coop_relay.yaml"), "--launch",  "--duration", "240",
        "--lcm-url", own_url(relay ? 4 : 5),           "--results", results,      "--no-plots"};
    if (!relay) arguments.insert(arguments.end(), {"--set", "vehicles.boat.devices.gateway.only_prefix=nothing"});
    const Ended ended = run_shoal(arguments);
    EXPECT_EQ(ended.exit_code, 1) << ended.errors;  // too short for its rules
    // The order is said at 125 s for the first time, and a turn is lost in 36 of 100 cases.
    const std::string executed = relay ? "station: 1 of 1 orders executed" : "station: 0 of 1 orders executed";
    EXPECT_THAT(text_of_file(results + "/station.log"), HasSubstr(executed));
    EXPECT_THAT(text_of_file(results + "/auv.log"), HasSubstr(relay ? "1 orders executed" : "0 orders executed"));
  }
}

TEST(CoopRelay, ARefusedOrderComesBackToTheStationByTheRelay) {
  const ScratchFolder folder;
  // The first order is for 15 m.
  const std::string change = "processes.auv.args.order_depth_max_m=12";
  const Ended ended = run_shoal({"run", source("worlds/coop_relay.yaml"), "--launch", "--duration", "300", "--lcm-url",
                                 own_url(6), "--results", folder.file("out"), "--no-plots", "--set", change});
  EXPECT_EQ(ended.exit_code, 1) << ended.errors;  // its rules fail
  const std::string reported = text_of_file(folder.file("out/station.log"));
  EXPECT_THAT(reported, HasSubstr("station: order 1 was refused: too deep, 15 m\n"));
  EXPECT_THAT(reported, HasSubstr("station: 0 of 1 orders executed, 1 refused"));
  EXPECT_THAT(text_of_file(folder.file("out/auv.log")), HasSubstr("0 orders executed, 1 refused"));
}

/// The summary of the first minutes of a world with its programs.
nlohmann::json summary_of(const std::string& world, const std::string& results, int url, const std::string& threads) {
  const Ended ended =
      run_shoal({"run", source(world), "--launch", "--duration", "300", "--threads", threads, "--speed",
                 threads == "1" ? "max" : "200", "--lcm-url", own_url(url), "--results", results, "--no-plots"});
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
    // With GPS of 1 m before the dive and ranges of decimeters after it.
    EXPECT_LT(first["metrics"]["cooperative.rms_m"], 6) << world;
    EXPECT_GT(first["acoustics"]["sent"], 20) << world;
  }
}

}  // namespace
