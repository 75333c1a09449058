// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/thruster_command.hpp"

#include <gtest/gtest.h>

namespace {

using devices::Thruster;
using devices::ThrusterCommand;

TEST(ThrusterCommand, InvertsAQuadraticCurveAheadAndAstern) {
  Thruster::Params params;
  params.command = Thruster::Command::radps;
  params.max = 100;
  params.ahead = 0.01;
  params.astern = 0.005;
  const ThrusterCommand curve(params);
  EXPECT_DOUBLE_EQ(curve.max_N(1000), 100);
  EXPECT_DOUBLE_EQ(curve.min_N(1000), -50);
  EXPECT_DOUBLE_EQ(curve.command_for_N(25, 0, 1000), 50);
  EXPECT_DOUBLE_EQ(curve.command_for_N(-12.5, 0, 1000), -50);
  EXPECT_EQ(curve.command_for_N(0, 1, 1000), 0);
  EXPECT_EQ(curve.command_for_N(1e4, 0, 1000), 100);  // cut at its limit
}

TEST(ThrusterCommand, AllowsForTheInflowOfAPropeller) {
  Thruster::Params params;
  params.curve = Thruster::Curve::kt_kq;
  params.command = Thruster::Command::rpm;
  params.max = 1525;
  params.diameter_m = 0.14;
  params.k_t0 = 0.4566;
  params.k_t_slope = 0.41737033;
  params.wake_fraction = 0.056;
  params.thrust_deduction = 0.1;
  const ThrusterCommand curve(params);
  // 1200 rpm in 1.5 m/s: T = 0.9 rho D^4 n (K_T0 n - s 0.944 u / D).
  const double n = 20, D = 0.14;
  const double thrust_N = 0.9 * 1026 * D * D * D * D * n * (0.4566 * n - 0.41737033 * 0.944 * 1.5 / D);
  EXPECT_NEAR(curve.command_for_N(thrust_N, 1.5, 1026), 1200, 1e-9);
  EXPECT_NEAR(curve.force_N(1200, 1.5, 1026), thrust_N, 1e-9);
  // What its speed allows in this flow is less than at the bollard.
  EXPECT_EQ(curve.command_for_N(curve.max_N(1026), 1.5, 1026), 1525);
  EXPECT_LT(curve.force_N(1525, 1.5, 1026), 0.8 * curve.max_N(1026));
  EXPECT_NEAR(curve.force_N(curve.command_for_N(-10, -0.5, 1026), -0.5, 1026), -10, 1e-9);
}

TEST(ThrusterCommand, ReadsATableBackwardsAndStepsOverItsDeadBand) {
  Thruster::Params params;
  params.curve = Thruster::Curve::table;
  params.table = {-1, -40, -0.1, 0, 0.1, 0, 1, 50};
  const ThrusterCommand curve(params);
  EXPECT_NEAR(curve.command_for_N(25, 0, 1000), 0.55, 1e-12);
  EXPECT_NEAR(curve.command_for_N(-20, 0, 1000), -0.55, 1e-12);
  EXPECT_EQ(curve.command_for_N(0, 0, 1000), 0);
  EXPECT_NEAR(curve.command_for_N(0.1, 0, 1000), 0.1018, 1e-12);
  EXPECT_NEAR(curve.force_N(0.1018, 3, 1000), 0.1, 1e-12);
}

}  // namespace
