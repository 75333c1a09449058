// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/helm_law.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/devices/autopilot/autopilot_world.hpp"

namespace {

using namespace autopilot_world;

TEST(Autopilot, ANaiveAuvFollowsItsWaypointsByItsHelm) {
  AutopilotWorld test(R"(
shoal: 1
physics: {step_s: 0.01}
medium: {water: {}, current: [{type: constant, velocity_mps: [0, 0.3, 0]}]}
vehicles:
  - name: v
    position_m: [0, 0, -5]
    model:
      shoal: 1
      vehicle: naive
      bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}]
      devices:
        - {name: drive, type: naive_drive}
        - {name: autopilot, type: autopilot, helm: drive, waypoints: [{at_m: [1000, 0], depth_m: 8, speed_mps: 1.5}]}
)");
  const auto state = test.state_after(200);
  EXPECT_NEAR(state.cross_track_m, 0, 0.1);
  EXPECT_NEAR(test.place().z(), -8, 0.05);
  EXPECT_NEAR(state.heading_rad, -std::asin(0.2), 0.02);
}

TEST(Autopilot, TheSpeedOfANaiveAuvIsThroughTheWater) {
  AutopilotWorld test(R"(
shoal: 1
physics: {step_s: 0.01}
medium: {water: {}, current: [{velocity_mps: [0.6, 0, 0]}]}
vehicles:
  - name: v
    position_m: [0, 0, -5]
    model:
      shoal: 1
      vehicle: naive
      bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}]
      devices:
        - {name: drive, type: naive_drive}
        - {name: autopilot, type: autopilot, helm: drive, hold: {speed_mps: 1.5, heading_deg: 0}}
)");
  const auto state = test.state_after(60);
  // It is carried along at 2.1 m/s over ground.
  EXPECT_NEAR(state.speed_error_mps, 0, 1e-3);
}

TEST(Autopilot, ANaiveAuvKeepsItsAltitudeWhateverTheTide) {
  AutopilotWorld test(R"(
shoal: 1
physics: {step_s: 0.02}
medium: {water: {}, tides: [{amplitude_m: 5}]}
objects: [{name: bottom, fixed: true, position_m: [0, 0, -30], parts: [{shape: plane}]}]
vehicles:
  - name: v
    position_m: [0, 0, -20]
    model:
      shoal: 1
      vehicle: naive
      bodies: [{name: hull, kinematic: true, parts: []}]
      devices:
        - {name: drive, type: naive_drive}
        - {name: autopilot, type: autopilot, helm: drive, hold: {speed_mps: 1.5, altitude_m: 6}}
)");
  const auto state = test.state_after(120);
  EXPECT_NEAR(state.altitude_error_m, 0, 0.01);
  EXPECT_NEAR(test.place().z(), -24, 0.01);
}

}  // namespace
