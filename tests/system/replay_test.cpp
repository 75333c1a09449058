// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>

#include "bridges/lcm/lcm_listener.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_state_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/system/shoal_program.hpp"

// `shoal replay` of runs with programs outside.

namespace {

using namespace system_test;
using testing::AnyOf;
using testing::HasSubstr;

Ended replay(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"replay", "--quiet"});
  return run_shoal(arguments);
}

class ReplayOf : public testing::TestWithParam<const char*> {};

TEST_P(ReplayOf, AMissionWithItsProgramsIsEqual) {
  const ScratchFolder folder;
  const std::string log = folder.file("run.lcm");
  const Ended run = run_shoal({"run", source(GetParam()), "--launch", "--duration", "20", "--speed", "max", "--lcm-url",
                               own_url(), "--record", log});
  ASSERT_TRUE(run.exit_code == 0 || run.exit_code == 1) << run.errors;
  const Ended again = replay({log});
  EXPECT_EQ(again.exit_code, 0) << again.output << again.errors;
  EXPECT_THAT(again.output, HasSubstr("equal for "));
  const Ended threads = replay({log, "--threads", "8"});
  EXPECT_EQ(threads.exit_code, 0) << threads.output << threads.errors;
}

INSTANTIATE_TEST_SUITE_P(Worlds, ReplayOf,
                         testing::Values("worlds/coop_land.yaml", "worlds/coop_underwater.yaml",
                                         "worlds/coop_relay.yaml", "worlds/ranger_dock.yaml",
                                         "worlds/avoid_crossing.yaml", "worlds/avoid_piles.yaml",
                                         "worlds/avoid_rovers.yaml", "worlds/formation.yaml"),
                         [](const auto& test) { return std::filesystem::path(test.param).stem().string(); });

TEST(Replay, FindsAPlantedDifferenceAndWritesAReport) {
  const ScratchFolder folder;
  const std::string log = folder.file("run.lcm");
  ASSERT_EQ(run_shoal({"run", source("worlds/minimal.yaml"), "--duration", "10", "--speed", "max", "--bus", "none",
                       "--record", log})
                .exit_code,
            0);
  const Ended changed = replay(
      {log, "--set", "vehicles.rover1.devices.odometry.noise.gaussian_std=0.5", "--report", folder.file("report.txt")});
  EXPECT_EQ(changed.exit_code, 1) << changed.output << changed.errors;
  EXPECT_THAT(changed.output, HasSubstr("rover1/odometry (rover1.odometry): "));
  const std::string report = text_of_file(folder.file("report.txt"));
  EXPECT_THAT(report,
              AllOf(HasSubstr("World (- in the log, + here):"), HasSubstr("gaussian_std: 0.5"),
                    HasSubstr("no difference of motion was seen"), HasSubstr("Channels, where each differs first")));
  EXPECT_EQ(replay({log, "--world", source("worlds/minimal.yaml")}).exit_code, 0);
  EXPECT_EQ(replay({log, "--set", "no.such.key=1"}).exit_code, 2);
  EXPECT_EQ(replay({folder.file("report.txt")}).exit_code, 4);
}

TEST(Replay, ARunThatBeganWithASnapshotIsRunAgainFromThere) {
  const ScratchFolder folder;
  const std::string snapshot = folder.file("snaps") + "/branch0_step1000.snapshot";
  const Ended first =
      run_shoal({"run", source("worlds/coop_land.yaml"), "--launch", "--duration", "12", "--speed", "max", "--lcm-url",
                 own_url(), "--snapshot-at", "10", "--snapshots", folder.file("snaps")});
  ASSERT_THAT(first.exit_code, AnyOf(0, 1)) << first.errors;
  const std::vector<std::string> from{"run", "--from",  snapshot, "--launch",  "--duration",
                                      "20",  "--speed", "max",    "--lcm-url", own_url()};
  const auto run = [&](const std::string& log, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = from;
    arguments.insert(arguments.end(), {"--record", log});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_shoal(arguments);
  };
  const Ended plain = run(folder.file("plain.lcm"), {});
  EXPECT_THAT(plain.exit_code, AnyOf(0, 1)) << plain.errors;
  const Ended again = replay({folder.file("plain.lcm")});
  EXPECT_EQ(again.exit_code, 0) << again.output << again.errors;
  EXPECT_THAT(again.output, HasSubstr("equal for 1000 steps (from step 1000; 11 hashes, "));
  const Ended changed = run(folder.file("set.lcm"), {"--set", "vehicles.rover3.devices.lidar.rate_hz=5"});
  EXPECT_THAT(changed.exit_code, AnyOf(0, 1)) << changed.errors;
  EXPECT_EQ(replay({folder.file("set.lcm")}).exit_code, 0);
  const Ended differs = replay({folder.file("plain.lcm"), "--set", "vehicles.rover3.devices.lidar.rate_hz=5"});
  EXPECT_EQ(differs.exit_code, 1) << differs.output << differs.errors;
  EXPECT_THAT(replay({folder.file("plain.lcm"), "--set", "vehicles.rover3.devices.lidar.name=eye"}).errors,
              HasSubstr("plain.lcm: sim.snapshot: "));
}

TEST(Replay, ALogOfLcmLoggerIsEnough) {
  const ScratchFolder folder;
  Program logger({"lcm-logger", "--force", "--flush-interval=20", "--lcm-url=" + own_url(), folder.file("logger.lcm")});
  bridges::LcmListener listener(own_url());
  ASSERT_TRUE(await([&] {  // it listens when the first probe is in the file
    listener.publish("probe", lcm_test::bytes_of("are you there"));
    std::error_code error;
    const auto size = std::filesystem::file_size(folder.file("logger.lcm"), error);
    return !error && size > 0;
  }));
  listener.listen("sim.state");
  Program shoal({built("shoal"), "run", source("worlds/minimal.yaml"), "--duration", "6", "--speed", "2", "--quiet",
                 "--lcm-url", own_url()});
  int commands = 0;
  while (shoal.running()) {
    const auto message = listener.next(100ms);
    if (!message || message->channel != "sim.state") continue;
    shoal::twist_command_t command{};
    command.forward_mps = 0.3 + 0.01 * ++commands;
    listener.publish("rover1.drive.cmd", shoal::encode(command));
    listener.publish("from.a.stranger", lcm_test::bytes_of("hello"));
  }
  EXPECT_EQ(shoal.wait(), 0) << shoal.errors();
  EXPECT_GT(commands, 10);
  logger.send_signal(SIGINT);
  logger.wait();
  const Ended again = replay({folder.file("logger.lcm")});
  // lcm-logger may lose a message on a busy machine: then it is said, and nothing is taken for a difference.
  EXPECT_THAT(again.exit_code, AnyOf(0, 4)) << again.output << again.errors;
  EXPECT_THAT(again.output, HasSubstr("equal for ")) << again.errors;
  if (again.exit_code == 4) {
    EXPECT_THAT(again.output, HasSubstr("missing"));
  }
}

TEST(Replay, WhatClientsDidToTheWorldIsDoneAgain) {
  const ScratchFolder folder;
  const std::string log = folder.file("run.lcm");
  const auto control = [](std::vector<std::string> arguments) {
    const Ended ended = system_test::control(std::move(arguments));
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  };
  const auto vehicles = [](bridges::LcmListener& listener, int count) {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (std::chrono::steady_clock::now() < deadline) {
      const auto message = listener.next(100ms);
      if (message && shoal::decode<shoal::sim_state_t>(message->payload, shoal::Finite::any).count == count)
        return true;
    }
    return false;
  };
  bridges::LcmListener listener(own_url());
  listener.listen("sim.state");
  Program shoal({built("shoal"), "run", source("worlds/minimal.yaml"), "--duration", "forever", "--lcm-url", own_url(),
                 "--record", log});
  ASSERT_TRUE(vehicles(listener, 1));
  control({"spawn", "{name: guest, file: rover.yaml, position_m: [0, 3, 0]}"});
  ASSERT_TRUE(vehicles(listener, 2));
  Program client({built("shoal"), "control", "spawn", "--stay", "--timeout", "60", "--lcm-url", own_url(),
                  "{name: other, file: rover.yaml, position_m: [0, -3, 0], with_client: true, alive_timeout_s: 1}"});
  ASSERT_TRUE(vehicles(listener, 3));
  client.send_signal(SIGKILL);  // its vehicle goes when it has been silent for 1 s of wall time
  ASSERT_TRUE(vehicles(listener, 2));
  control({"remove", "guest"});
  ASSERT_TRUE(vehicles(listener, 1));
  control({"quit"});
  EXPECT_EQ(shoal.wait(), 0) << shoal.errors();
  const Ended again = replay({log});
  EXPECT_EQ(again.exit_code, 0) << again.output << again.errors;
}

}  // namespace
