// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/system/shoal_program.hpp"

namespace {

using system_test::built;
using system_test::Ended;
using system_test::run_shoal;
using system_test::ScratchFolder;
using system_test::source;
using testing::HasSubstr;

Ended run_segway(std::vector<std::string> more) {
  std::vector<std::string> arguments{"run", source("worlds/segway.yaml"), "--launch", "--lcm-url",
                                     system_test::own_url(0)};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_shoal(std::move(arguments));
}

TEST(SegwayRun, AnotherProcessBalancesItForTenMinutesOnCommand) {
  const Ended ended = run_segway({"--duration", "600"});
  EXPECT_EQ(ended.exit_code, 0) << ended.output << ended.errors;  // the rules of the world: up, and on its way
}

TEST(SegwayRun, FallsWhenItIsTooLate) {
  // After 5.4 s, says docs/models/segway.md.
  const Ended ended = run_segway(
      {"--duration", "12", "--set", "vehicles.segway1.actuator_latency_s=0.14", "--set", "physics.step_s=0.001"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.output, testing::ContainsRegex("tilt.fell_s +5[.]"));
  EXPECT_THAT(ended.output, HasSubstr("FAILED: fallen.count == 0 (left 1, right 0)"));
}

TEST(SegwayRun, IsTheSameAtAnySpeed) {
  const auto hash = [](const std::string& speed) {
    return system_test::run_hash_in(run_segway({"--duration", "6", "--speed", speed}));
  };
  const std::string fast = hash("max");
  EXPECT_EQ(fast.size(), 16u) << fast;
  EXPECT_EQ(fast, hash("4"));
}

TEST(SegwayRun, ItsProgramSaysWhatIsWrongWithItsOptions) {
  const std::pair<std::vector<std::string>, const char*> mistakes[] = {
      {{}, "--name is required"},
      {{"--name", "s", "--speeds", "[[1]]"}, "--speeds: 'speeds[1]' must be 2 to 3 numbers, got 1"},
      {{"--name", "s", "--speeds", "[[1,x]]"}, "item 2 of 'speeds[1]' must be a number, got 'x'"},
      {{"--name", "s", "--speeds", "[[2,1],[1,0]]"}, "the times of the speeds must increase"},
      {{"--name", "s", "--kp-Nm-per-rad", "nan"}, "--kp-Nm-per-rad: must be from 0 to 10000, got 'nan'"},
      {{"--name", "s", "--period-s", "0"}, "--period-s"},
  };
  for (const auto& [options, reports] : mistakes) {
    std::vector<std::string> arguments{built("shoal-balance")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    system_test::Program program(std::move(arguments));
    EXPECT_EQ(program.wait(), 2) << reports;
    EXPECT_THAT(program.errors(), HasSubstr(reports));
  }
}

}  // namespace
