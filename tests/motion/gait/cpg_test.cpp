// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/cpg.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "motion/analysis/motion_check.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/project_paths.hpp"

namespace {

using motion::Cpg;

sim::VehicleConfig oscillating_dog() {
  return sim::load_vehicle(test_support::source_path("vehicles/ers7.yaml"));
}

std::vector<double> start_of(const Cpg& gait) {
  std::vector<double> values;
  for (const motion::GaitNumber& number : gait.numbers()) values.push_back(number.start);
  return values;
}

TEST(Cpg, LegsSwingForwardInTheAirAndBackOnTheGround) {
  const Cpg gait(oscillating_dog());
  const std::vector<double> values = start_of(gait);
  ASSERT_EQ(values.size(), 8u);
  for (const motion::Leg& leg : gait.legs()) {
    const auto foot = [&](double phase) { return leg.foot_at(Cpg::posture_at(values, leg, phase)); };
    // The hip turns the leg forward about phase 0, with the knee bent by its amplitude, and back about phase 0.5.
    const auto hip = [&](double phase) { return Cpg::posture_at(values, leg, phase).swing; };
    const double forward = -leg.swing_sign;
    EXPECT_NEAR(forward * (hip(0.25) - hip(-0.25)), 2 * values[Cpg::swing_amplitude], 1e-12);
    EXPECT_NEAR(Cpg::posture_at(values, leg, 0).knee - Cpg::posture_at(values, leg, 0.5).knee,
                values[Cpg::knee_amplitude], 1e-12);
    EXPECT_GT(foot(0).z(), foot(0.5).z() + 0.005) << leg.name;
  }
}

TEST(Cpg, CoursesAreSinesOfTheTime) {
  const Cpg gait(oscillating_dog());
  std::vector<double> values = start_of(gait);
  values[Cpg::period] = 0.8;
  values[Cpg::knee_amplitude] = 0.2;  // slow enough for the servos
  const sim::JointMotion motion = gait.motion(values);
  ASSERT_EQ(motion.keys.size(), 101u);
  for (std::size_t i = 0; i < 100; ++i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / 100;
    // The left front leg is first; its swing is positive forward.
    EXPECT_NEAR(motion.keys[i].joints[0].second, -0.35 + 0.2 * std::sin(angle), 1e-9);
    EXPECT_NEAR(motion.keys[i].joints[2].second, 0.9 + 0.1 * (1 + std::cos(angle)), 1e-9);
  }
}

TEST(Cpg, ServosAreWithinTheirRangesAndSpeedsInAllCornersOfTheSearch) {
  const sim::VehicleConfig vehicle = oscillating_dog();
  const Cpg gait(vehicle);
  for (unsigned bits = 0; bits < 256; ++bits) {
    std::vector<double> values;
    for (std::size_t i = 0; i < 8; ++i)
      values.push_back((bits >> i & 1) != 0 ? gait.numbers()[i].high : gait.numbers()[i].low);
    const auto findings = motion::check_motion(gait.motion(values), vehicle);
    EXPECT_TRUE(findings.empty()) << bits << ": " << findings.front().text();
  }
}

}  // namespace
