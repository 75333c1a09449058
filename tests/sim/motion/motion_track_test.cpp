// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/motion_track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using sim::Easing;

double between_0_and_2(Easing ease, double share) {
  const sim::MotionTrack track{"knee", {{1, 0, ease}, {3, 2, ease}}};
  return track.value_at(1 + 2 * share);
}

TEST(MotionTrack, HoldsItsEndsOutsideOfItsKeys) {
  const sim::MotionTrack track{"knee", {{1, 0.5, Easing::linear}, {2, 0.7, Easing::linear}}};
  EXPECT_EQ(track.value_at(0), 0.5);
  EXPECT_EQ(track.value_at(1), 0.5);
  EXPECT_EQ(track.value_at(2), 0.7);
  EXPECT_EQ(track.value_at(9), 0.7);
}

TEST(MotionTrack, EasesAsTheFormulasSay) {
  for (const double s : {0.0, 0.1, 0.25, 0.5, 0.8}) {
    EXPECT_NEAR(between_0_and_2(Easing::linear, s), 2 * s, 1e-15);
    EXPECT_NEAR(between_0_and_2(Easing::cosine, s), 1 - std::cos(std::numbers::pi * s), 1e-15);
    EXPECT_NEAR(between_0_and_2(Easing::smooth, s), 6 * s * s - 4 * s * s * s, 1e-15);
    EXPECT_EQ(between_0_and_2(Easing::step, s), 0);
  }
}

TEST(MotionTrack, ASplineOfAStraightLineIsStraightBetweenItsInnerKeys) {
  sim::MotionTrack track{"knee", {}};
  for (int i = 0; i < 5; ++i) track.keys.push_back({0.5 * i, 3.0 * i, Easing::spline});
  for (double t_s = 0.5; t_s <= 1.5; t_s += 0.05) EXPECT_NEAR(track.value_at(t_s), 6 * t_s, 1e-12) << t_s;
}

TEST(MotionTrack, ASplineHasEqualSlopesBeforeAndAfterAKey) {
  const sim::MotionTrack track{
      "knee", {{0, 0, Easing::spline}, {1, 1, Easing::spline}, {1.5, -1, Easing::spline}, {3, 0, Easing::spline}}};
  const double h = 1e-6;
  for (const double t_s : {1.0, 1.5}) {
    const double before = (track.value_at(t_s) - track.value_at(t_s - h)) / h;
    const double after = (track.value_at(t_s + h) - track.value_at(t_s)) / h;
    EXPECT_NEAR(before, after, 1e-4);  // second derivatives below 30 times h
  }
  // Catmull-Rom: the slope at the second key is that from the first to the third.
  EXPECT_NEAR((track.value_at(1 + h) - track.value_at(1 - h)) / (2 * h), -1 / 1.5, 1e-4);
}

}  // namespace
