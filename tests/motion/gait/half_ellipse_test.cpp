// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/half_ellipse.hpp"

#include <gmock/gmock.h>

#include "motion/analysis/motion_check.hpp"
#include "motion/gait/leg_motion.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/motion/gait/ers7_gait.hpp"

namespace {

using namespace ers7_gait;

using motion::HalfEllipse;

/// Corners of the ranges, in turn low and high.
std::vector<double> corner_of(const HalfEllipse& gait, unsigned bits) {
  std::vector<double> values;
  for (std::size_t i = 0; i < gait.numbers().size(); ++i)
    values.push_back((bits >> i & 1) != 0 ? gait.numbers()[i].high : gait.numbers()[i].low);
  return values;
}

TEST(HalfEllipse, TheFeetAreOnTheLocus) {
  const HalfEllipse gait(ers7());
  const std::vector<double> values = start_of(gait);
  for (const motion::Leg& leg : gait.legs())
    for (int i = 0; i < 100; ++i) {
      const sim::Vector3d desired = HalfEllipse::foot_at(values, leg, i / 100.0);
      const motion::LegPosture posture = leg.posture_at(desired);
      ASSERT_TRUE(posture.reached);
      EXPECT_LT((leg.foot_at(posture) - desired).norm(), 1e-9);
    }
}

TEST(HalfEllipse, ALocusHasItsLengthHeightAndShareOnTheGround) {
  const HalfEllipse gait(ers7());
  std::vector<double> values = start_of(gait);
  values[HalfEllipse::ground_share] = 0.4;
  values[HalfEllipse::skew] = 0.1;
  for (const motion::Leg& leg : gait.legs()) {
    const bool left = leg.hip.y() > 0;
    const double length_m = values[HalfEllipse::length] * (left ? 1.1 : 0.9);
    const sim::Vector3d down = HalfEllipse::foot_at(values, leg, 0), up = HalfEllipse::foot_at(values, leg, 0.4);
    EXPECT_NEAR(down.x() - up.x(), length_m, 1e-12);
    EXPECT_NEAR(HalfEllipse::foot_at(values, leg, 0.2).z(), down.z(), 1e-12);
    EXPECT_NEAR(HalfEllipse::foot_at(values, leg, 0.7).z() - down.z(), values[HalfEllipse::front_height], 1e-3);
  }
}

TEST(HalfEllipse, ServosAreWithinTheirRangesAndSpeedsInAllCornersOfTheSearch) {
  const sim::VehicleConfig vehicle = ers7();
  const HalfEllipse gait(vehicle);
  for (unsigned bits = 0; bits < 4096; bits += 13) {
    const auto findings = motion::check_motion(gait.motion(corner_of(gait, bits)), vehicle);
    EXPECT_TRUE(findings.empty()) << bits << ": " << findings.front().text();
  }
}

TEST(HalfEllipse, TheEndIsTheStart) {
  const HalfEllipse gait(ers7());
  const sim::JointMotion motion = gait.motion(start_of(gait));
  EXPECT_TRUE(motion.loop);
  EXPECT_EQ(motion.keys.front().joints, motion.keys.back().joints);
  // 0.7 s are 87.5 frames of 8 ms.
  EXPECT_DOUBLE_EQ(motion.end_s(), 88 * 0.008);
}

TEST(HalfEllipse, LeftAndRightAreHalfAPeriodApart) {
  const HalfEllipse gait(ers7());
  const sim::JointMotion motion = gait.motion(start_of(gait));
  const std::size_t frames = motion.keys.size() - 1;
  for (std::size_t i = 0; i < frames; ++i) {
    const auto& now = motion.keys[i].joints;
    const auto& later = motion.keys[(i + frames / 2) % frames].joints;
    for (std::size_t j = 0; j < 3; ++j) {
      // Legs lf, rf, lh, rh; mirrored joints have equal numbers.
      EXPECT_NEAR(now[j].second, later[3 + j].second, 1e-12);
      EXPECT_NEAR(now[6 + j].second, later[9 + j].second, 1e-12);
    }
  }
}

}  // namespace
