// SPDX-License-Identifier: BSD-3-Clause
#include "verification/motions/real_walk.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "devices/joint/joint_servo.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"

namespace {

using verification::RealWalk;

sim::WorldConfig studio_of_walks() {
  return sim::load_world(test_support::source_path("worlds/ers7_studio.yaml")).config;
}

TEST(RealWalk, ThreeOfNineStridesAreFittedAndTheErrorIsRelative) {
  std::vector<RealWalk> walks = verification::fast_forward_strides();
  ASSERT_EQ(walks.size(), 9u);
  EXPECT_EQ(std::count_if(walks.begin(), walks.end(), [](const RealWalk& walk) { return walk.is_fitted; }), 3);
  EXPECT_EQ(verification::fast_forward_turns().size(), 7u);
  std::vector<double> simulated;
  for (const RealWalk& walk : walks) simulated.push_back(walk.measured * (walk.is_fitted ? 1.1 : 1));
  EXPECT_NEAR(verification::relative_rms(walks, simulated, true), 0.1, 1e-12);
  EXPECT_NEAR(verification::relative_rms(walks, simulated, false), 0.1 * std::sqrt(3.0 / 9), 1e-12);
}

TEST(RealWalk, ParametersAreThoseOfTheLegServosOnly) {
  verification::DogParameters parameters;
  parameters.effort_Nm = 0.9;
  parameters.play_rad = 0.02;
  const sim::WorldConfig world = verification::with_parameters(studio_of_walks(), "dog", parameters);
  int legs = 0;
  for (const sim::DeviceConfig& device : world.vehicles.front().config->devices) {
    const auto* servo = dynamic_cast<const sim::detail::ParamsOf<devices::JointServo::Params>*>(device.params.get());
    if (servo == nullptr) continue;
    const bool is_of_leg = device.name.starts_with("lf_") || device.name.starts_with("rf_") ||
                           device.name.starts_with("lh_") || device.name.starts_with("rh_");
    EXPECT_EQ(servo->params.gear.play, is_of_leg ? 0.02 : 0) << device.name;
    EXPECT_EQ(servo->params.max_effort == 0.9, is_of_leg) << device.name;
    legs += is_of_leg ? 1 : 0;
  }
  EXPECT_EQ(legs, 12);
}

TEST(RealWalk, TheModelWalksAsTheDogDoesAndTurnsLeft) {
  // Two strides and a turn.  The bounds are wide: twice the error of the table in docs/models/ers7.md.
  std::vector<RealWalk> walks;
  for (const RealWalk& walk : verification::fast_forward_strides())
    if (walk.step.forward_m == 0.03 || walk.step.forward_m == 0.05) walks.push_back(walk);
  walks.push_back(verification::fast_forward_turns().front());
  ASSERT_EQ(walks.size(), 3u);
  const std::vector<double> speeds =
      verification::simulated_speeds(studio_of_walks(), "dog", walks, {.warm_up_s = 1, .measured_s = 2}, 2);
  EXPECT_NEAR(speeds[0], walks[0].measured, 0.2 * walks[0].measured);
  EXPECT_NEAR(speeds[1], walks[1].measured, 0.2 * walks[1].measured);
  EXPECT_NEAR(speeds[2], walks[2].measured, 0.5 * walks[2].measured);
}

}  // namespace
