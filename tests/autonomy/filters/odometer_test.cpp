// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/filters/odometer.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "autonomy/filters/ekf.hpp"

namespace {

using autonomy::Increment;
using std::numbers::pi;

TEST(Odometer, GivesMovesInTheBodyFrame) {
  autonomy::Odometer odometer({{10, 0}, pi / 2});
  odometer.update({0, 0}, pi / 2);
  const Increment move = odometer.update({0, 3}, pi / 2);  // it looks along y of its start frame and drives there
  EXPECT_NEAR(move.forward_m, 3, 1e-12);
  EXPECT_NEAR(move.left_m, 0, 1e-12);
  EXPECT_NEAR(move.turn_rad, 0, 1e-12);
  EXPECT_NEAR(odometer.pose().p_W.x(), 7, 1e-12);  // the start frame itself looks north
  EXPECT_NEAR(odometer.pose().yaw_rad, pi, 1e-12);
}

}  // namespace
