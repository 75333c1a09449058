// SPDX-License-Identifier: BSD-3-Clause
#include "tests/system/two_machines.hpp"

#include <gmock/gmock.h>

#include "tests/system/shoal_program.hpp"

// A run on one machine and its clients on another, over a network that delays and loses packets.

namespace {

using namespace system_test;
using testing::HasSubstr;
using Arguments = std::vector<std::string>;

constexpr unsigned seed = 7;
constexpr const char* group = "udpm://239.255.76.67:7667?ttl=1";

Arguments joined(Arguments first, const Arguments& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

/// A run of two rovers in lockstep with two clients, whose commands depend on every byte that they get.
struct SharedRun {
  std::function<Arguments(std::size_t machine, Arguments program)> on;
  std::string url;

  /// The run hash, and what each client printed.
  std::string fly() const {
    const ScratchFolder folder;
    write_file(
        folder.file("world.yaml"),
        "shoal: 1\nname: shared\nrun: {duration_s: 2, speed: max}\nstate_rate_hz: 20\nobjects:\n  - {name: ground, "
        "fixed: true, parts: [{shape: plane}]}\nvehicles:\n  - {name: rover1, file: " +
            source("vehicles/rover.yaml") + ", position_m: [0, 0, 0.2]}\n  - {name: rover2, file: " +
            source("vehicles/rover.yaml") + ", position_m: [0, 5, 0.2]}\n");
    const std::string results = folder.file("results");
    Program shoal(on(0, {built("shoal"), "run", folder.file("world.yaml"), "--lcm-url", url, "--await", "a,b",
                         "--control-key", "--results", results}));
    // The clients need the key of the run, which is copied to their machine.
    if (!await([&] { return text_of_file(results + "/run.key").size() >= 64; }, timeout)) return shoal.errors();
    const std::string key = text_of_file(results + "/run.key").substr(0, 64);
    const Arguments with_key{"env", "SHOAL_RUN_KEY=" + key, built("lockstep_pilot"), "--lcm-url", url};
    Program a(on(1, joined(with_key, {"--name", "a", "--vehicle", "rover1", "--period", "0.05", "--receive",
                                      "rover1.odometry", "b.note", "sim.clock"})));
    Program b(on(1, joined(with_key, {"--name", "b", "--vehicle", "rover2", "--period", "0.1", "--receive",
                                      "rover2.odometry", "a.note", "rover1.odometry"})));
    if (const int code = shoal.wait(); code != 0) return "exit code " + std::to_string(code) + ": " + shoal.errors();
    std::string result = summary_value(results, "run_hash");
    for (Program* pilot : {&a, &b}) {
      const int code = pilot->wait();
      const std::string output = pilot->output();
      result += "\n" + std::to_string(code) + " " + output.substr(0, output.find(" requested"));
    }
    return result;
  }
};

std::string on_one_machine() {
  return SharedRun{[](std::size_t, Arguments program) { return program; }, own_url()}.fly();
}

TEST(TwoMachines, InLockstepARunIsTheSameAsOnOneMachine) {
  const TwoMachines machines(seed);
  if (!machines.permitted()) GTEST_SKIP() << "networks of their own, or /dev/net/tun, are not permitted here";
  const auto on = [&](std::size_t machine, const Arguments& program) { return machines.on(machine, program); };
  const std::string expected = on_one_machine();
  EXPECT_THAT(expected, HasSubstr("ticks 41"));  // every 0.05 s from 0 to 2 s
  EXPECT_EQ((SharedRun{on, group}.fly()), expected);
}

TEST(TwoMachines, InLockstepOverTheServerOfTcpqARunIsTheSameAsOnOneMachine) {
  const TwoMachines machines(seed);
  if (!machines.permitted()) GTEST_SKIP() << "networks of their own, or /dev/net/tun, are not permitted here";
  const auto on = [&](std::size_t machine, const Arguments& program) { return machines.on(machine, program); };
  const std::string address = TwoMachines::addresses[0];
  Program server(on(0, {built("shoal"), "tcpq", "--host", address}));
  ASSERT_TRUE(await([&] { return server.output().find("tcpq://" + address + ":7700") != std::string::npos; }, timeout))
      << server.errors();
  EXPECT_EQ((SharedRun{on, "tcpq://" + address + ":7700"}.fly()), on_one_machine());
}

TEST(TwoMachines, TheDoctorOfEachReachesTheOther) {
  const TwoMachines machines(seed);
  if (!machines.permitted()) GTEST_SKIP() << "networks of their own, or /dev/net/tun, are not permitted here";
  const std::string one = TwoMachines::addresses[0], other = TwoMachines::addresses[1];
  // Nothing runs there yet, and nothing leaves this machine
  Program alone(machines.on(0, {built("shoal"), "doctor", "--peer", other}));
  EXPECT_EQ(alone.wait(), 4);
  EXPECT_THAT(alone.output(),
              HasSubstr("warning tcpq server: none at 10.9.0.2:7700 (Connection refused); start one there: "
                        "shoal tcpq --host 10.9.0.2\n"));
  EXPECT_THAT(alone.output(), HasSubstr("the URL has ttl=0"));
  EXPECT_THAT(alone.output(), HasSubstr("BAD     connection: no bus reaches 10.9.0.2\n"));
  // Both at the same time
  Program server(machines.on(1, {built("shoal"), "tcpq", "--host", other}));
  ASSERT_TRUE(await([&] { return server.output().find("tcpq://") != std::string::npos; }, timeout)) << server.errors();
  Program here(machines.on(0, {built("shoal"), "doctor", "--peer", other, "--lcm-url", group}));
  Program there(machines.on(1, {built("shoal"), "doctor", "--peer", one, "--lcm-url", group}));
  EXPECT_EQ(here.wait(), 0) << here.output();
  EXPECT_EQ(there.wait(), 0) << there.output();
  EXPECT_THAT(here.output(), HasSubstr("ok      route: this machine is 10.9.0.1 for it\n"));
  EXPECT_THAT(here.output(), HasSubstr("ok      tcpq server: 10.9.0.2:7700 passes messages on, round trip "));
  EXPECT_THAT(here.output(), HasSubstr("ok      multicast: "));
  EXPECT_THAT(there.output(), HasSubstr("ok      multicast: "));
}

}  // namespace
