// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/autopilot_control.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

/// x'' = a + disturbance, from rest; the error of x against 1 after a time.
struct Plant {
  double x = 0, v = 0, fastest = 0;

  double run(devices::AxisHold& hold, double time_s, double disturbance, double desired) {
    const double dt_s = 0.01;
    for (double t = 0; t < time_s; t += dt_s) {
      v += (hold.step(desired - x, v, dt_s, false) + disturbance) * dt_s;
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
  // The slow pole of s^3 + 2 w s^2 + w^2 s + 0.1 w^3 is at -0.126 w: exp(-0.126 * 0.5 * 200) = 3e-6.
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
  EXPECT_LE(plant.fastest, 0.2 * 1.001);  // the sum begins to push where the rate becomes free
  EXPECT_GT(plant.fastest, 0.19);
  // The sum begins only on the last 0.8 m, where the rate is free.
  EXPECT_LT(furthest, 0.2);
  EXPECT_NEAR(plant.x, 10, 0.01);
}

TEST(RateHold, BringsAPlantWithDragToItsSpeedAndAFrozenSumStands) {
  devices::RateHold hold(0.5, 0.25);
  double v = 0;
  for (int i = 0; i < 8000; ++i) v += (hold.step(1.5 - v, 0.01, false) - 0.2 * v) * 0.01;
  EXPECT_NEAR(v, 1.5, 1e-4);
  const double before = hold.step(0, 0.01, false);
  for (int i = 0; i < 100; ++i) hold.step(1, 0.01, true);
  EXPECT_EQ(hold.step(0, 0.01, false), before);
}

}  // namespace
