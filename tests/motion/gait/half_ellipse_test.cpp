// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/half_ellipse.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "motion/analysis/motion_check.hpp"
#include "motion/gait/leg_motion.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/project_paths.hpp"

namespace {

using motion::HalfEllipse;

sim::VehicleConfig ers7() {
  return sim::load_vehicle(test_support::source_path("vehicles/ers7.yaml"));
}

std::vector<double> start_of(const HalfEllipse& gait) {
  std::vector<double> values;
  for (const motion::GaitNumber& number : gait.numbers()) values.push_back(number.start);
  return values;
}

/// Corners of the ranges, in turn low and high.
std::vector<double> corner_of(const HalfEllipse& gait, unsigned bits) {
  std::vector<double> values;
  for (std::size_t i = 0; i < gait.numbers().size(); ++i)
    values.push_back((bits >> i & 1) != 0 ? gait.numbers()[i].high : gait.numbers()[i].low);
  return values;
}

TEST(Leg, TheLengthsOfTheErs7AreThoseOfItsFile) {
  const std::vector<motion::Leg> legs = motion::legs_of(ers7());
  ASSERT_EQ(legs.size(), 4u);
  EXPECT_EQ(legs[0].name, "lf");
  EXPECT_TRUE(legs[0].hip.isApprox(sim::Vector3d(0.065, 0.0625, 0)));
  EXPECT_TRUE(legs[3].knee.isApprox(sim::Vector3d(-0.074, -0.0625, -0.0695)));
  // The knee's body, and the ball in it.
  EXPECT_TRUE(legs[0].foot.isApprox(sim::Vector3d(0.074 - 0.00503, 0.0625 + 0.0047, -0.0695 - 0.06524)));
  EXPECT_TRUE(legs[0].foot_at({}).isApprox(legs[0].foot));
  // The flap is narrowed to the narrowest row of the table of two joints: -1 and 0 degrees.
  EXPECT_NEAR(legs[0].flap_limits.low, -M_PI / 180, 1e-12);
  EXPECT_NEAR(legs[2].flap_limits.low, 0, 1e-12);
}

TEST(Leg, JointsTurnAsTheirAxesSay) {
  const std::vector<motion::Leg> legs = motion::legs_of(ers7());
  // Positive: front forward, rear backward, flap outwards (docs/models/ers7.md).
  EXPECT_GT(legs[0].foot_at({0.5, 0, 0}).x(), legs[0].foot.x());
  EXPECT_GT(legs[0].foot_at({0, 0, 0.5}).x(), legs[0].foot.x());
  EXPECT_LT(legs[2].foot_at({0.5, 0, 0}).x(), legs[2].foot.x());
  EXPECT_LT(legs[3].foot_at({0, 0, 0.5}).x(), legs[3].foot.x());
  EXPECT_GT(legs[0].foot_at({0, 0.5, 0}).y(), legs[0].foot.y());
  EXPECT_LT(legs[1].foot_at({0, 0.5, 0}).y(), legs[1].foot.y());
}

TEST(Leg, APostureThatWasForwardIsFoundBackward) {
  // The rear leg is straight at 0.33, and its knee turned in the positive direction above.
  for (const motion::Leg& leg : motion::legs_of(ers7()))
    for (const double swing : {-1.0, -0.2, 0.4, 1.1})
      for (const double flap : {-0.1, 0.0, 0.4, 1.0})
        for (const double knee : {0.5, 0.9, 1.7}) {
          const motion::LegPosture found = leg.posture_at(leg.foot_at({swing, flap, knee}));
          EXPECT_TRUE(found.reached);
          EXPECT_NEAR(found.swing, swing, 1e-9) << leg.name << swing << flap << knee;
          EXPECT_NEAR(found.flap, flap, 1e-9);
          EXPECT_NEAR(found.knee, knee, 1e-9);
        }
}

TEST(Leg, OutOfReachItIsStraightTowardsThePoint) {
  for (const motion::Leg& leg : motion::legs_of(ers7())) {
    const sim::Vector3d far = leg.hip + sim::Vector3d(0.1, leg.foot.y() - leg.hip.y(), -0.3);
    const motion::LegPosture posture = leg.posture_at(far);
    EXPECT_FALSE(posture.reached);
    const sim::Vector3d foot = leg.foot_at(posture) - leg.hip, desired = far - leg.hip;
    EXPECT_LT(foot.norm(), desired.norm());
    EXPECT_NEAR(foot.x() / foot.z(), desired.x() / desired.z(), 1e-9);
  }
}

TEST(Leg, AVehicleWithoutLegsIsRefusedWithWhatIsMissing) {
  sim::VehicleConfig vehicle = ers7();
  std::erase_if(vehicle.devices, [](const sim::DeviceConfig& one) { return one.name == "rh_flap"; });
  try {
    motion::legs_of(vehicle);
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_STREQ(error.what(), "vehicle 'ers7': no legs for a gait: it has no joint_servo 'rh_flap'");
  }
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

TEST(HalfEllipse, TheMotionPutsTheFeetOnTheLocus) {
  const HalfEllipse gait(ers7());
  std::vector<double> values = start_of(gait);
  values[HalfEllipse::length] = 0.03;  // slow enough for the servos, and within all ranges
  values[HalfEllipse::front_height] = values[HalfEllipse::rear_height] = 0.01;
  values[HalfEllipse::period] = 1;
  const sim::JointMotion motion = gait.motion(values);
  const int frames = gait.frames(values);
  const motion::Leg& leg = gait.legs()[0];
  for (int i = 0; i < frames; ++i) {
    const auto& joints = motion.keys[static_cast<std::size_t>(i)].joints;  // lf is the first leg
    const sim::Vector3d foot = leg.foot_at({joints[0].second, joints[1].second, joints[2].second});
    EXPECT_LT((foot - HalfEllipse::foot_at(values, leg, static_cast<double>(i) / frames)).norm(), 1e-9) << i;
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

TEST(HalfEllipse, StepsOfACourseAreLimitedWithoutDelay) {
  // A jump of 4 in steps of 1 begins before it and ends after it, in equal parts.
  const std::vector<double> limited = motion::with_limited_steps({0, 0, 0, 0, 4, 4, 4, 4}, 1);
  EXPECT_EQ(limited, (std::vector<double>{1.5, 1, 1, 1.5, 2.5, 3, 3, 2.5}));
  EXPECT_EQ(motion::with_limited_steps({0, 1, 2, 1}, 1), (std::vector<double>{0, 1, 2, 1}));
}

}  // namespace
