// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "motion/analysis/motion_file.hpp"
#include "tests/tools/shoal/called_command.hpp"
#include "tests/tools/shoal/motion/leg_files.hpp"

namespace {

using testing::HasSubstr;

std::string refusal(std::vector<std::string> words) {
  words.insert(words.begin(), {"motion", "stability"});
  words.insert(words.end(), {"--world", "ers7_studio"});
  const test::Called called = test::call_shoal(words);
  EXPECT_EQ(called.exit_code, 2);
  return called.err;
}

TEST(MotionStabilityCommand, TheThresholdsOfItsClassesAreInOrder) {
  EXPECT_THAT(refusal({"bend.yaml", "--marginal", "0.5", "--stable", "0.4"}),
              HasSubstr("--marginal must be at most --stable, 0.4, got 0.5"));
  EXPECT_THAT(refusal({"bend.yaml", "--marginal", "0.1", "--stable", "0.4", "--greatest", "0.3"}),
              HasSubstr("--greatest must be at least --stable, 0.4, got 0.3"));
}

TEST(MotionStabilityCommand, AMotionOfFramesNeedsTheTimeBetweenItsRows) {
  const test::LegFiles files;
  sim::JointMotion frames;
  frames.name = "frames";
  frames.frames = {{"knee", {{0, 0, sim::Easing::linear}, {1, 0.5, sim::Easing::linear}}}};
  motion::write_motion(files.path("frames.yaml"), frames);
  EXPECT_THAT(refusal({files.path("frames.yaml"), "--marginal", "0.1", "--stable", "0.4", "--greatest", "6"}),
              HasSubstr("the motion has frames: give the times with --every"));
}

}  // namespace
