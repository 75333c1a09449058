// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/system/shoal_program.hpp"

// Programs that see: a Segway and a dog chase a ball with their cameras.

namespace {

using namespace system_test;
using testing::HasSubstr;

Ended chase(const std::string& world, std::vector<std::string> more) {
  std::vector<std::string> arguments{
      "run", source("worlds/" + world + ".yaml"), "--launch", "--speed", "max", "--lcm-url", own_url()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_shoal(std::move(arguments), 3 * timeout);
}

class BallChaseOf : public testing::TestWithParam<const char*> {};

TEST_P(BallChaseOf, ReachesAndKicksTheBallAndIsReplayed) {
  const ScratchFolder folder;
  const Ended run = chase(GetParam(), {"--record", folder.file("run.lcm")});
  EXPECT_EQ(run.exit_code, 0) << run.output << run.errors;  // the rules of the world
  const Ended again = run_shoal({"replay", folder.file("run.lcm"), "--quiet", "--threads", "3"}, 3 * timeout);
  EXPECT_EQ(again.exit_code, 0) << again.output << again.errors;
  EXPECT_THAT(again.output, HasSubstr("equal for "));
}

TEST_P(BallChaseOf, FailsWithoutItsCamera) {
  const std::string vehicle = std::string(GetParam()) == "ball_chase" ? "segway1" : "dog";
  const std::string silent =
      "events=[{name: blind, at: 0, do: [{fault: {device: " + vehicle + "/camera, kind: silent}}]}]";
  const Ended blind = chase(GetParam(), {"--duration", "10", "--set", silent});
  EXPECT_EQ(blind.exit_code, 1) << blind.output << blind.errors;
  EXPECT_THAT(blind.output, HasSubstr("FAILED: kicked.time_s"));
}

TEST_P(BallChaseOf, EverySeedPlacesTheBallElsewhereWithAndWithoutABus) {
  const auto hash = [](const std::string& seed, const std::vector<std::string>& bus) {
    std::vector<std::string> arguments{
        "run", source("worlds/" + std::string(GetParam()) + ".yaml"), "--speed", "max", "--duration", "0.2", "--seed",
        seed};
    arguments.insert(arguments.end(), bus.begin(), bus.end());
    return run_hash_in(run_shoal(std::move(arguments)));
  };
  const std::string first = hash("1", {"--bus", "none"});
  EXPECT_EQ(first.size(), 16u) << first;
  EXPECT_EQ(first, hash("1", {"--lcm-url", own_url()}));
  EXPECT_NE(first, hash("2", {"--bus", "none"}));
}

INSTANTIATE_TEST_SUITE_P(Worlds, BallChaseOf, testing::Values("ball_chase", "ball_chase_ers7"),
                         [](const auto& test) { return std::string(test.param); });

TEST(BallChaseRun, EveryMotionOfTheDogKeepsItsLimits) {
  for (const auto& entry : std::filesystem::directory_iterator(source("vehicles/motions/ers7_ball"))) {
    const Ended ended = run_shoal({"motion", "check", entry.path().string()});
    EXPECT_EQ(ended.exit_code, 0) << ended.output << ended.errors;
  }
}

TEST(BallChaseRun, ItsProgramsReportMissingNames) {
  for (const char* name : {"shoal-ball-chase", "shoal-ball-dog"}) {
    Program without_name({built(name)});
    EXPECT_EQ(without_name.wait(), 2);
    EXPECT_THAT(without_name.errors(), HasSubstr("--name is required"));
    Program without_vehicle({built(name), "--name", "chase"});
    EXPECT_EQ(without_vehicle.wait(), 2);
    EXPECT_THAT(without_vehicle.errors(), HasSubstr("--vehicle is required"));
  }
}

}  // namespace
