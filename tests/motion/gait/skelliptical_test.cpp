// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/skelliptical.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "motion/analysis/motion_check.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/project_paths.hpp"

namespace {

using motion::Skelliptical;

sim::VehicleConfig aibo() {
  return sim::load_vehicle(test_support::source_path("vehicles/ers7.yaml"));
}

/// Returns a leg whose foot is the point on which this walk stands.
motion::Leg standing(motion::Leg leg) {
  // From the knee, by the measurements of rUNSWift: 25 mm back and 40 down in front, 35 ahead and 50 down behind.
  const bool front = motion::is_front(leg);
  leg.foot = leg.knee + sim::Vector3d(front ? -0.025 : 0.035, leg.foot.y() - leg.knee.y(), front ? -0.040 : -0.050);
  return leg;
}

TEST(Skelliptical, AFootIsOnTheGroundForItsShareAndMovesStraightBack) {
  const std::vector<double> values = Skelliptical::fast_forward();
  for (const bool front : {true, false}) {
    const double share = values[front ? Skelliptical::front_ground_share : Skelliptical::rear_ground_share];
    int on_ground = 0;
    for (int i = -1000; i < 1000; ++i) {
      const Skelliptical::Stroke stroke = Skelliptical::stroke_at(values, front, i / 1000.0);
      if (!stroke.on_ground) continue;
      ++on_ground;
      EXPECT_DOUBLE_EQ(stroke.along, -i / 1000.0);
    }
    EXPECT_NEAR(on_ground / 2000.0, share, 1.0 / 1000);
  }
}

TEST(Skelliptical, AStrokeIsContinuousAndAsHighAsItsLift) {
  const std::vector<double> values = Skelliptical::fast_forward();
  for (const bool front : {true, false}) {
    EXPECT_DOUBLE_EQ(Skelliptical::stroke_at(values, front, 1).height, 1);
    EXPECT_DOUBLE_EQ(Skelliptical::stroke_at(values, front, -1).height, 1);
    EXPECT_NEAR(Skelliptical::stroke_at(values, front, 1).along, Skelliptical::stroke_at(values, front, -1).along,
                1e-9);
    for (int i = -10000; i < 10000; ++i) {
      const auto a = Skelliptical::stroke_at(values, front, i * 1e-4);
      const auto b = Skelliptical::stroke_at(values, front, (i + 1) * 1e-4);
      // The steepest parts are the ramps: 4.1 % of the lift in 2.7 % of 47.8 %, and the ends of the ellipse: 90 degrees
      // in 41 %, over 59 % of a stride; the thrust falls within the ramp out, 1.3 % of a half period.
      EXPECT_NEAR(a.height, b.height, 4e-4);
      EXPECT_NEAR(a.along, b.along, 2.3e-4);
      EXPECT_NEAR(a.thrust, b.thrust, 1e-4 / (0.478 * 0.027) * 1.01);
    }
  }
}

TEST(Skelliptical, TheFeetOfFastForwardAreWhereItsNumbersSay) {
  const Skelliptical gait(aibo());
  const std::vector<double> values = Skelliptical::fast_forward();
  // In the middle of the ground stroke, without thrust: 74.4 and 119.5 mm below the hips, 3 mm lower by the canter; the
  // nose is down by asin(45.1 / 130).
  const double tilt_rad = std::asin(0.0451 / 0.130);
  // Lengths are in proportion to the front legs, whose length is known to 0.01 %.
  const double rounding = 2e-5;
  for (const motion::Leg& leg : gait.legs()) {
    const motion::LegPosture posture = gait.posture_at(values, {.forward_m = 0.05}, leg, 0);
    ASSERT_TRUE(posture.reached) << leg.name;
    const sim::Vector3d from_hip = standing(leg).foot_at(posture) - leg.hip;
    const double level_x = std::cos(tilt_rad) * from_hip.x() + std::sin(tilt_rad) * from_hip.z();
    const double level_z = -std::sin(tilt_rad) * from_hip.x() + std::cos(tilt_rad) * from_hip.z();
    const bool front = motion::is_front(leg);
    EXPECT_NEAR(level_x, front ? 0.0271 : -0.0112, rounding) << leg.name;
    EXPECT_NEAR(level_z, front ? -0.0774 : -0.1225, rounding) << leg.name;
    EXPECT_NEAR(motion::side_of(leg) * from_hip.y(), front ? 0.0096 : 0.0063, rounding) << leg.name;
  }
}

TEST(Skelliptical, FeetTurnAboutTheMiddleOfTheHips) {
  const Skelliptical gait(aibo());
  std::vector<double> values = Skelliptical::fast_forward();
  values[Skelliptical::thrust] = values[Skelliptical::canter] = 0;
  values[Skelliptical::front_side_body_height] = values[Skelliptical::front_body_height];
  const double tilt_rad = std::asin(0.0451 / 0.130), turn_rad = 0.3;
  for (const motion::Leg& leg : gait.legs()) {
    const auto ground = [&](double phase) {
      const auto posture = gait.posture_at(values, {.turn_rad = turn_rad}, leg, phase);
      const sim::Vector3d p = standing(leg).foot_at(posture);
      return Eigen::Vector2d(std::cos(tilt_rad) * p.x() + std::sin(tilt_rad) * p.z(), p.y());
    };
    // Flat on the ground from -0.4 to 0.4: turned by 0.8 * 0.3 rad clockwise about the middle, so the body turns left.
    // The team takes the feet 4.7 mm further out than their hips: the distance changes a little.
    const Eigen::Vector2d first = ground(-0.4), last = ground(0.4);
    const double turned = std::remainder(std::atan2(last.y(), last.x()) - std::atan2(first.y(), first.x()), 2 * M_PI);
    EXPECT_NEAR(turned, -0.8 * turn_rad, 0.02) << leg.name;
    EXPECT_NEAR(first.norm(), last.norm(), 0.003) << leg.name;
  }
}

TEST(Skelliptical, TheGaitIsWithinTheRangesAndSpeedsOfTheServos) {
  const sim::VehicleConfig vehicle = aibo();
  const Skelliptical gait(vehicle);
  ASSERT_EQ(gait.numbers().size(), 32u);
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::vector<double> values;
    unsigned bits = seed * 2654435761u;
    for (const motion::GaitNumber& number : gait.numbers()) {
      EXPECT_LE(number.low, number.start) << number.name;
      EXPECT_LE(number.start, number.high) << number.name;
      bits = bits * 1664525u + 1013904223u;
      values.push_back(number.low + (number.high - number.low) * (bits >> 16) / 65535.0);
    }
    const auto findings = motion::check_motion(gait.motion(values), vehicle);
    EXPECT_TRUE(findings.empty()) << seed << ": " << findings.front().text();
  }
}

TEST(Skelliptical, DiagonalLegsMoveTogether) {
  const Skelliptical gait(aibo());
  const sim::JointMotion motion =
      gait.motion(Skelliptical::fast_forward(), {.forward_m = 0.05}, motion::CourseLimit::range);
  // 22 frames of 8 ms in half a period.
  ASSERT_EQ(motion.keys.size(), 45u);
  for (std::size_t i = 0; i < 44; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(motion.keys[i].joints[j].second, motion.keys[(i + 22) % 44].joints[3 + j].second, 1e-12);
      EXPECT_NEAR(motion.keys[i].joints[6 + j].second, motion.keys[(i + 22) % 44].joints[9 + j].second, 1e-12);
    }
}

}  // namespace
