// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/motion_frames.hpp"

#include <gtest/gtest.h>

namespace {

std::string error_of(const std::string& text) {
  sim::FramesError error;
  const auto tracks = sim::parse_motion_frames(text, error);
  EXPECT_EQ(tracks.empty(), !error.text.empty());
  return error.text.empty() ? "" : std::to_string(error.line) + ":" + std::to_string(error.column) + ": " + error.text;
}

TEST(MotionFrames, AreReadWithRemarksAndSpaces) {
  sim::FramesError error;
  const auto tracks = sim::parse_motion_frames("# by hand\r\nt_s, knee ,hip\r\n0, 0.1, 0.2\n\n0.008,0.3,-4e-1", error);
  ASSERT_EQ(error.text, "");
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_EQ(tracks[0].joint, "knee");
  EXPECT_EQ(tracks[1].joint, "hip");
  ASSERT_EQ(tracks[1].keys.size(), 2u);
  EXPECT_EQ(tracks[1].keys[1].at_s, 0.008);
  EXPECT_EQ(tracks[1].keys[1].value, -0.4);
}

TEST(MotionFrames, TheirTextReadsToTheSameBits) {
  std::vector<sim::MotionTrack> tracks{{"a", {}}, {"b", {}}};
  for (int i = 0; i < 100; ++i) {
    const double t_s = 0.008 * i;
    tracks[0].keys.push_back({t_s, 1.0 / (i + 3), sim::Easing::linear});
    tracks[1].keys.push_back({t_s, -1e-7 * i * i, sim::Easing::linear});
  }
  sim::FramesError error;
  const auto again = sim::parse_motion_frames(sim::motion_frames_text(tracks), error);
  ASSERT_EQ(error.text, "");
  for (std::size_t joint = 0; joint < 2; ++joint)
    for (std::size_t i = 0; i < 100; ++i) {
      EXPECT_EQ(again[joint].keys[i].at_s, tracks[joint].keys[i].at_s);
      EXPECT_EQ(again[joint].keys[i].value, tracks[joint].keys[i].value);
    }
}

TEST(MotionFrames, SaysWhereAndWhatIsWrong) {
  EXPECT_EQ(error_of(""), "1:1: must start with the line 't_s,JOINT,...'");
  EXPECT_EQ(error_of("time,knee\n0,1\n"), "1:1: the first column must be 't_s', got 'time'");
  EXPECT_EQ(error_of("t_s\n0\n"), "1:1: needs the name of a joint after 't_s'");
  EXPECT_EQ(error_of("t_s,a,,b\n"), "1:7: needs the name of a joint");
  EXPECT_EQ(error_of("t_s,a, a\n"), "1:8: names joint 'a' twice");
  EXPECT_EQ(error_of("t_s,a\n"), "1:1: needs a line of values after the names of joints");
  EXPECT_EQ(error_of("t_s,a\n0,1\n0.1,1,2\n"), "3:1: must have 2 values, got 3");
  EXPECT_EQ(error_of("t_s,a\n# first\n0, x1\n"), "3:4: must be a number from -1e6 to 1e6, got 'x1'");
  EXPECT_EQ(error_of("t_s,a\n0,nan\n"), "2:3: must be a number from -1e6 to 1e6, got 'nan'");
  EXPECT_EQ(error_of("t_s,a\n0,1e9\n"), "2:3: must be a number from -1e6 to 1e6, got '1e9'");
  EXPECT_EQ(error_of("t_s,a\n-1,0\n"), "2:1: 't_s' must be >= 0 and <= 86400, got -1");
  EXPECT_EQ(error_of("t_s,a\n0.1,0\n0.1,0\n"), "3:1: 't_s' must increase: 0.1 comes after 0.1");
}

TEST(MotionFrames, AreSampledAtWholePeriods) {
  const std::vector<sim::MotionTrack> tracks{{"a", {{0, 0, sim::Easing::linear}, {1, 10, sim::Easing::linear}}}};
  const auto samples = sim::sampled(tracks, 1, 0.25);
  ASSERT_EQ(samples[0].keys.size(), 5u);
  EXPECT_EQ(samples[0].keys[3].at_s, 0.75);
  EXPECT_EQ(samples[0].keys[3].value, 7.5);
}

}  // namespace
