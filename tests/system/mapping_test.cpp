// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/system/shoal_program.hpp"

// A rover that maps a car park, the truth to score it by, and `shoal map`.

namespace {

using namespace system_test;
using testing::HasSubstr;

std::vector<std::string> mapping(const std::string& duration_s, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{
      "run",    source("worlds/slam_days.yaml"), "--launch", "--speed", "max", "--duration", duration_s, "--lcm-url",
      own_url()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Maps every minute, which are scored from the first round on.
const std::vector<std::string> often = {"--set", "processes.mapper.args.map_every_s=60", "--set",
                                        "metrics.map.from_s=500"};

TEST(Mapping, TenMinutesOfTheCarParkAreMappedRepeatedAndReplayed) {
  const ScratchFolder folder;
  std::vector<std::string> arguments = mapping("600", often);
  arguments.insert(arguments.end(), {"--record", folder.file("run.lcm"), "--set",
                                     "pass=[path.ate_m < 0.1, path.lost_s == 0, map.still_iou > 0.9]"});
  const Ended run = run_shoal(arguments, 3 * timeout);
  EXPECT_EQ(run.exit_code, 0) << run.output << run.errors;
  const Ended again = run_shoal({"replay", folder.file("run.lcm"), "--quiet", "--threads", "2"}, 3 * timeout);
  EXPECT_EQ(again.exit_code, 0) << again.output << again.errors;
  EXPECT_THAT(again.output, HasSubstr("equal for "));
  // The true map and the published one, of the record.
  const Ended truth = run_shoal({"map", folder.file("run.lcm"), "--at", "590", "--out", folder.file("true.png")});
  EXPECT_EQ(truth.exit_code, 0) << truth.errors;
  EXPECT_THAT(text_of_file(folder.file("true.yaml")),
              HasSubstr("image: 'true.png'\nmode: trinary\nresolution: 0.05\n"));
  const Ended published = run_shoal({"map", folder.file("run.lcm"), "--channel", "rover1.map", "--at", "300", "--every",
                                     "120", "--until", "540", "--out", folder.file("map.png")});
  EXPECT_EQ(published.exit_code, 0) << published.errors;
  EXPECT_TRUE(std::filesystem::exists(folder.file("map_0002.png")));
  EXPECT_THAT(text_of_file(folder.file("map_0002.yaml")), HasSubstr("origin: [-22, -16, 0.0]"));
}

TEST(Mapping, ACarriedRoverIsFoundAgain) {
  const Ended run = run_shoal({"run", source("worlds/slam_carried.yaml"), "--launch", "--speed", "max", "--lcm-url",
                               own_url(), "--seed", "3", "--set", "pass=[path.max_m > 1, path.lost_s < 60]"},
                              3 * timeout);
  EXPECT_EQ(run.exit_code, 0) << run.output << run.errors;
}

TEST(FindTheWay, ItsRulesHoldAndTheRunIsRepeatedAndReplayed) {
  const ScratchFolder folder;
  std::vector<std::string> arguments{"run",   source("worlds/find_the_way.yaml"), "--launch",  "--speed", "max",
                                     "--set", "lockstep.timeout_s=1000",          "--lcm-url", own_url()};
  const Ended again = run_shoal(arguments, 3 * timeout);
  arguments.insert(arguments.end(), {"--record", folder.file("run.lcm")});
  const Ended run = run_shoal(arguments, 3 * timeout);
  EXPECT_EQ(run.exit_code, 0) << run.output << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("planner: the path is blocked at ("));
  EXPECT_THAT(run.errors, HasSubstr("planner: 7 goals reached, 0 given up"));
  EXPECT_EQ(run_hash_in(again), run_hash_in(run));
  const Ended replayed = run_shoal({"replay", folder.file("run.lcm"), "--quiet"}, 3 * timeout);
  EXPECT_EQ(replayed.exit_code, 0) << replayed.output << replayed.errors;
}

TEST(FindTheWay, GoalsComeFromAChannelAndOneWithoutAWayIsReported) {
  const Ended run = run_shoal(
      {"run", source("worlds/find_the_way.yaml"), "--launch", "--speed", "max", "--duration", "20", "--lcm-url",
       own_url(), "--set", "pass=[]", "--set", "metrics=[]", "--set",
       "events=[{name: wish, at: 5, do: [{publish: {channel: rover1.goals, type: shoal.waypoints_command_t, value: "
       "{x_m: [-11], y_m: [5]}}}]}]"});
  EXPECT_EQ(run.exit_code, 0) << run.output << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("to (-11.0, 5.0): the goal is 0."));
}

TEST(FindTheWay, AMapThatIsMissingIsWrongUsage) {
  Program localizer({built("shoal-localizer"), "--name", "a", "--vehicle", "b", "--map-file", "none.yaml"});
  EXPECT_EQ(localizer.wait(), 2);
  EXPECT_THAT(localizer.errors(), HasSubstr("none.yaml"));
}

TEST(MapCommand, WritesTheTrueMapOfAWorldAtAnyTime) {
  const ScratchFolder folder;
  const Ended early =
      run_shoal({"map", "slam_days", "--at", "10", "--area=-20,-15,20,15", "--out", folder.file("a.png")});
  EXPECT_EQ(early.exit_code, 0) << early.errors;
  EXPECT_THAT(early.output, HasSubstr("800 x 600 cells of 0.05 m, "));
  EXPECT_THAT(text_of_file(folder.file("a.yaml")), HasSubstr("origin: [-20, -15, 0.0]"));
}

TEST(MapCommand, ReportsWhatItCannotDo) {
  const auto errors = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "map");
    const Ended ended = run_shoal(std::move(arguments));
    EXPECT_NE(ended.exit_code, 0);
    return ended.errors;
  };
  EXPECT_THAT(errors({"minimal", "--out", "map.pgm"}), HasSubstr("--out: must end in .png, got 'map.pgm'"));
  EXPECT_THAT(errors({"minimal", "--area", "1,2,3"}),
              HasSubstr("--area: must be four numbers in meters such as -20,-15,20,15, got '1,2,3'"));
  EXPECT_THAT(errors({"minimal", "--area", "3,0,1,1"}),
              HasSubstr("--area: the area must go from a smaller to a larger"));
  EXPECT_THAT(errors({"minimal", "--height", "900"}), HasSubstr("no object is 900 m above zero"));
  EXPECT_THAT(errors({"minimal", "--channel", "map"}), HasSubstr("--channel needs a log"));
}

TEST(Mapping, ItsProgramsReportMissingNames) {
  for (const char* name : {"shoal-mapper", "shoal-patrol", "shoal-localizer", "shoal-planner"}) {
    std::vector<std::string> words{built(name)};
    if (std::string(name) == "shoal-patrol") words.insert(words.end(), {"--waypoints-m", "[[0,0]]"});
    if (std::string(name) == "shoal-localizer") words.insert(words.end(), {"--map-file", "a.yaml"});
    Program without_name(words);
    EXPECT_EQ(without_name.wait(), 2);
    EXPECT_THAT(without_name.errors(), HasSubstr("--name is required"));
    words.insert(words.end(), {"--name", "a"});
    Program without_vehicle(words);
    EXPECT_EQ(without_vehicle.wait(), 2);
    EXPECT_THAT(without_vehicle.errors(), HasSubstr("--vehicle is required"));
  }
}

}  // namespace
