// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/autopilot_control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/autopilot/autopilot_world.hpp"

namespace {

/// x'' = a + disturbance, from rest, with an actuator that gives no more than its limit; the error of x after a time.
struct Plant {
  double x = 0, v = 0, fastest = 0, limit = std::numeric_limits<double>::infinity(), given = 0;

  double run(devices::AxisHold& hold, double time_s, double disturbance, double desired) {
    const double dt_s = 0.01;
    for (double t = 0; t < time_s; t += dt_s) {
      given = std::clamp(hold.step(desired - x, v, given, dt_s), -limit, limit);
      v += (given + disturbance) * dt_s;
      x += v * dt_s;
      fastest = std::max(fastest, std::abs(v));
    }
    return desired - x;
  }
};

TEST(AxisHold, FollowsTheCriticallyDampedStepOfTheTextbook) {
  // Without the sum of errors: x'' + 2 w x' + w^2 x = w^2, so that 1 - x = (1 + w t) exp(-w t).
  devices::AxisHold hold({0.5, 1, 100, 0});
  Plant plant;
  const double error = plant.run(hold, 4, 0, 1);
  EXPECT_NEAR(error, 3 * std::exp(-2), 0.01);  // steps of 0.01 s: first order in w dt = 0.005
}

TEST(AxisHold, TakesAwayASteadyDisturbance) {
  devices::AxisHold hold({0.5, 1, 100, 0.1});
  Plant plant;
  // The estimate decays to it at 0.1 w: 0.3 exp(-0.1 * 0.5 * 200) = 1.4e-5, over the stiffness of about w^2 = 0.25.
  EXPECT_NEAR(plant.run(hold, 200, 0.3, 1), 0, 1e-4);
}

TEST(AxisHold, WithoutTheSumTheDisturbanceLeavesItsStiffness) {
  devices::AxisHold hold({0.5, 1, 100, 0});
  Plant plant;
  EXPECT_NEAR(plant.run(hold, 200, 0.3, 1), -0.3 / 0.25, 1e-6);
}

TEST(AxisHold, KeepsItsRateAndDoesNotWindUpOnALongWay) {
  devices::AxisHold hold({0.5, 1, 0.2, 0.1});
  Plant plant;
  double furthest = 0;
  for (int i = 0; i < 100; ++i) furthest = std::max(furthest, -plant.run(hold, 2, 0, 10));
  EXPECT_LE(plant.fastest, 0.2 * 1.001);
  EXPECT_GT(plant.fastest, 0.19);
  EXPECT_LT(furthest, 1e-9) << "without a disturbance there is nothing to sum";
  EXPECT_NEAR(plant.x, 10, 1e-3);
}

TEST(AxisHold, NoDisturbanceWithinTheLimitOfItsActuatorStopsItForGood) {
  // Of the limited rate alone it would give 2 w 0.2 = 0.2.
  for (const double disturbance : {-0.15, -0.25, -0.9, 0.9}) {
    devices::AxisHold hold({0.5, 1, 0.2, 0.1});
    Plant plant;
    plant.limit = 1;
    // It is carried along at up to |d| / (2 w) for the 20 s of the estimate, and comes back at 0.2.
    EXPECT_NEAR(plant.run(hold, 600, disturbance, 10), 0, 1e-3) << disturbance;
  }
}

TEST(AxisHold, WhatItCouldNotStandDoesNotMatterAfterwards) {
  devices::AxisHold hold({0.5, 1, 0.2, 0.1});
  Plant plant;
  plant.limit = 1;
  plant.run(hold, 60, -1.01, 0);  // pushed off, slowly at the end
  EXPECT_LT(plant.x, -10);
  EXPECT_NEAR(plant.run(hold, 600, -0.5, 0), 0, 1e-3);
}

TEST(RateHold, BringsAPlantWithDragToItsSpeed) {
  devices::RateHold hold(0.5, 0.25);
  double v = 0, given = 0;
  // The slow pole of s^2 + (0.5 + 0.2 + 0.125) s + 0.125 * 0.5 is at -0.084: exp(-0.084 * 130) = 2e-5.
  for (int i = 0; i < 13000; ++i) v += ((given = hold.step(1.5 - v, v, given, 0.01)) - 0.2 * v) * 0.01;
  EXPECT_NEAR(v, 1.5, 1e-4);
}

TEST(RateHold, DoesNotWindUpAtTheLimitOfItsActuator) {
  devices::RateHold hold(0.5, 0.25);
  double v = 0, given = 0;
  const auto run = [&](double desired, double time_s) {
    double slowest = v;
    for (double t = 0; t < time_s; t += 0.01) {
      given = std::clamp(hold.step(desired - v, v, given, 0.01), -0.2, 0.2);
      v += (given - 0.2 * v) * 0.01;
      slowest = std::min(slowest, v);
    }
    return slowest;
  };
  run(1.5, 1000);
  EXPECT_NEAR(v, 1, 1e-3) << "0.2 against a drag of 0.2 v";
  // At once the drag of 1 m/s is 0.1 too much for 0.5 m/s: 0.1 / w, and less as the estimate follows.
  const double slowest = run(0.5, 100);
  EXPECT_GT(slowest, 0.45);
  EXPECT_NEAR(v, 0.5, 1e-4);
}

using namespace autopilot_world;

std::vector<std::string> level_lines(const std::string& overrides, bool warnings) {
  AutopilotWorld test(world_with("bluerov2_station.yaml", overrides));
  sim::Warnings& building = test.world.warnings().building();
  return warnings ? building.lines() : building.notes();
}

TEST(Autopilot, SaysUpToWhichSpeedItsGainsOutweighTheMunkMoment) {
  using testing::ElementsAre;
  using testing::HasSubstr;
  using testing::IsEmpty;
  // (w^2 (I + A) + W BG) / (Az - Ax) = (25 x 0.365 + 1.347) / 12.32 ahead, (25 x 0.449 + 1.347) / 11.56 aside.
  const std::string reported = "vehicle 'v': device 'autopilot': it holds the vehicle level up to ";
  EXPECT_THAT(
      level_lines("      devices.autopilot.mode: hold\n", false),
      ElementsAre(HasSubstr(reported + "0.92 m/s ahead and 1.04 m/s to the side; the thrusters reach 0.85 m/s and")));
  EXPECT_THAT(level_lines("      devices.autopilot.mode: hold\n", true), Not(testing::Contains(HasSubstr("level"))));
  // With 1.2 rad/s: (0.526 + 1.347) / 12.32, and the gain needed at 0.847 m/s is 4.53.
  EXPECT_THAT(level_lines("      devices.autopilot.gains.attitude.bandwidth_radps: 1.2\n", true),
              testing::Contains(AllOf(HasSubstr(reported + "0.39 m/s ahead"),
                                      HasSubstr("unless 'gains: attitude: bandwidth_radps' is above 4.53"))));
  EXPECT_THAT(level_lines("      devices.autopilot.axes: [surge, sway, heave, yaw]\n", true),
              testing::Contains(HasSubstr("the thrusters do not control its tilt")));
}

TEST(Autopilot, TurnsOverWhereItsGainsLoseToTheMunkMoment) {
  // The gains that are said to be enough below 0.39 m/s.
  const auto tilt_at = [](double speed_mps) {
    AutopilotWorld test(world_with("bluerov2_station.yaml",
                                   "      devices.autopilot.gains.attitude.bandwidth_radps: 1.2\n"
                                   "      devices.autopilot.mode: hold\n",
                                   "{water: {}}", -50));
    test.run_for(1);
    test.helm(speed_mps, 0, 50);
    double tilt = 0;
    for (int i = 0; i < 120; ++i) {
      test.run_for(1);
      tilt = std::max(tilt, tilt_deg(test));
    }
    return tilt;
  };
  EXPECT_LT(tilt_at(0.37), 5);
  // The estimate of the disturbance and a heave that gives way hold some more than the closed form.
  EXPECT_GT(tilt_at(0.5), 20);
}

}  // namespace
