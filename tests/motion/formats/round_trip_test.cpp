// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/motion/formats/format_fixture.hpp"

// What a format writes reads to the same course of each joint, for random motions.

namespace {

constexpr double urad = 1e-6;

/// A random motion of up to 6 joints whose keys are whole multiples of `tick_ms`; each joint has its own keys.
sim::JointMotion random_motion(int tick_ms, bool is_eased, double max_rad) {
  const int joints = *rc::gen::inRange(1, 7);
  const int keys = *rc::gen::inRange(1, 12);
  sim::JointMotion motion;
  motion.name = "random";
  motion.angles = sim::AngleUnit::rad;
  motion.start.min_s = *rc::gen::inRange(1, 3000) * 0.001;
  int at_ms = 0;
  for (int i = 0; i < keys; ++i) {
    sim::MotionKey& key = motion.keys.emplace_back();
    key.at_s = at_ms / 1000.0;
    at_ms += tick_ms * *rc::gen::inRange(1, 60);
    if (is_eased) key.ease = static_cast<sim::Easing>(*rc::gen::inRange(0, 5));
    for (int joint = 0; joint < joints; ++joint)
      if (joint == 0 || i == 0 || *rc::gen::arbitrary<bool>())
        key.joints.emplace_back("joint_" + std::to_string(8 + joint),
                                *rc::gen::inRange(-1'000'000'000, 1'000'000'000) * 1e-9 * max_rad);
  }
  return motion;
}

/// The greatest difference of two motions at the frames of 8 ms.
double difference(const sim::JointMotion& a, const sim::JointMotion& b) {
  double furthest = 0;
  for (const sim::MotionTrack& track : a.tracks()) {
    const auto tracks = b.tracks();
    const auto same =
        std::find_if(tracks.begin(), tracks.end(), [&](const auto& one) { return one.joint == track.joint; });
    if (same == tracks.end()) return 1e9;
    for (double k = 0; k * 0.008 <= a.end_s() + 1e-9; ++k)
      furthest = std::max(furthest, std::abs(track.value_at(k * 0.008) - same->value_at(k * 0.008)));
  }
  return furthest;
}

class RoundTrip : public testing::TestWithParam<const char*> {};

TEST_P(RoundTrip, KeepsTheCourseOfEachJointWithinAMicroradian) {
  const std::string format = GetParam();
  const int tick_ms = format == "mtn" ? 16 : 8;
  const bool ok = rc::check([&] {
    const sim::JointMotion motion = random_motion(tick_ms, format != "mtn", 3);
    const sim::JointMotion again = test::read(GetParam(), test::written(GetParam(), motion).bytes).motion;
    RC_ASSERT(std::abs(again.end_s() - motion.end_s()) < 1e-9);
    RC_ASSERT(difference(motion, again) <= urad);
    if (format == "mot" || format == "play_motion2") RC_ASSERT(std::abs(again.start.min_s - motion.start.min_s) < 1e-9);
    // What was read is written to the same bytes.
    sim::JointMotion once = again;
    once.name = motion.name;
    const std::string bytes = test::written(GetParam(), once).bytes;
    sim::JointMotion twice = test::read(GetParam(), bytes).motion;
    twice.name = motion.name;
    RC_ASSERT(test::written(GetParam(), twice).bytes == bytes);
  });
  EXPECT_TRUE(ok);
}

INSTANTIATE_TEST_SUITE_P(, RoundTrip, testing::Values("csv", "ros", "play_motion2", "webots", "mtn", "mot"),
                         [](const testing::TestParamInfo<const char*>& of) { return std::string(of.param); });

TEST(RoundTripOfPostures, KeepsThePoseWithinAMicroradian) {
  EXPECT_TRUE(rc::check([] {
    const sim::JointMotion motion = random_motion(8, false, 3);
    motion::FormatOptions options;
    options.at_s = motion.end_s() * 0.5;
    const sim::JointMotion again = test::read("pos", test::written("pos", motion, {}, options).bytes).motion;
    for (const sim::MotionTrack& track : motion.tracks())
      RC_ASSERT(std::abs(test::value(again, track.joint, 0) - track.value_at(*options.at_s)) <= urad);
  }));
}

TEST(RoundTripOfSkills, KeepsTheRowsWithinADegree) {
  constexpr double one_degree = std::numbers::pi / 180;
  EXPECT_TRUE(rc::check([] {
    const sim::JointMotion motion = random_motion(20, false, 4.4);
    const std::string bytes = test::written("opencat", motion).bytes;
    const sim::JointMotion again = test::read("opencat", bytes).motion;
    // The first and the last row are the poses at the ends, whatever the times between are.
    for (const sim::MotionTrack& track : motion.tracks()) {
      RC_ASSERT(std::abs(test::value(again, track.joint, 0) - track.value_at(0)) <= one_degree + 1e-9);
      RC_ASSERT(std::abs(test::value(again, track.joint, again.end_s()) - track.value_at(motion.end_s())) <=
                one_degree + 1e-9);
    }
    sim::JointMotion once = again;
    once.name = motion.name;
    const std::string second = test::written("opencat", once).bytes;
    RC_ASSERT(test::read("opencat", second).motion.keys.size() <= again.keys.size());
  }));
}

}  // namespace
