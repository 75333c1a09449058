// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/motion/formats/format_fixture.hpp"

namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(PlayMotion2Format, StartsAtTheLeastTimeOfTheApproach) {
  sim::JointMotion motion = test::motion({{0, {{"a", 0}, {"b", 1}}}, {0.8, {{"a", -0.5}}}});
  motion.description = "lifts: the paw";
  motion.start.min_s = 0.5;
  const test::Written file = test::written("play_motion2", motion);
  EXPECT_EQ(file.bytes,
            "play_motion2:\n  ros__parameters:\n    motions:\n      wave:\n        joints: [a, b]\n"
            "        positions: [0.0, 1.0, -0.5, 1.0]\n        times_from_start: [0.5, 1.3]\n"
            "        meta: {name: wave, usage: shoal, description: \"lifts: the paw\"}\n");
  EXPECT_THAT(file.losses, IsEmpty());
  const test::Read again = test::read("play_motion2", file.bytes);
  EXPECT_EQ(again.motion.name, "wave");
  EXPECT_EQ(again.motion.description, "lifts: the paw");
  EXPECT_DOUBLE_EQ(again.motion.start.min_s, 0.5);
  EXPECT_DOUBLE_EQ(again.motion.end_s(), 0.8);
  EXPECT_THAT(again.losses, IsEmpty());
}

TEST(PlayMotion2Format, ChoosesOneOfSeveralMotions) {
  const std::string text =
      "node:\n  ros__parameters:\n    motions:\n      home: {joints: [a], positions: [1.0], times_from_start: [0.5]}\n"
      "      wave: {joints: [a], positions: [2.0, 3.0], times_from_start: [0.5, 1.0]}\n";
  EXPECT_EQ(test::read_error("play_motion2", text), "file:4:7: has several motions: choose one (--name) of home, wave");
  motion::FormatOptions options;
  options.name = "wave";
  EXPECT_DOUBLE_EQ(test::value(test::read("play_motion2", text, {}, options).motion, "a", 0), 2);
  options.name = "wav";
  EXPECT_EQ(test::error_of([&] { test::read("play_motion2", text, {}, options); }),
            "file:4:7: there is no motion 'wav'; did you mean 'wave'?; known: home, wave");
}

TEST(PlayMotion2Format, SaysWhereAndWhatIsWrong) {
  const auto error = [](const std::string& motion) {
    return test::read_error("play_motion2", "motions:\n  wave: " + motion + "\n");
  };
  EXPECT_EQ(test::read_error("play_motion2", "a: {b: 1}\n"),
            "file:1:1: needs the map 'motions', below 'NODE: ros__parameters:'");
  EXPECT_EQ(error("3"), "file:2:3: motion 'wave' must be a map");
  EXPECT_THAT(error("{joints: [a], positions: [1, 2, 3], times_from_start: [0, 1]}"),
              HasSubstr("file:2:9: 'positions' must have 1 x 2 values, for each joint and time, got 3"));
  EXPECT_THAT(error("{joints: [a], positions: [1, 2], times_from_start: [1, 1]}"),
              HasSubstr("'times_from_start' must increase: 1 comes after 1"));
  EXPECT_THAT(error("{joints: [a], position: [1], times_from_start: [1]}"),
              HasSubstr("motion 'wave': unknown key 'position'"));
}

}  // namespace
