// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/foil.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "devices/marine/fin.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/marine/fin_fixture.hpp"
#include "tests/devices/marine/marine_fixture.hpp"

namespace {

using namespace fin_fixture;

using devices::Fin;
using test::degree;
using test::rounding_N;

TEST(Fin, LiftsAndDragsAsAThinWing) {
  const double slope = std::numbers::pi * 3 / (1 + std::sqrt(1 + 2.25));
  const double C_L = slope * 0.1, q_A = 0.5 * 1000 * 4 * 0.02;
  const sim::Vector3d F =
      force("area_m2: 0.02, aspect_ratio: 3, drag_coefficient: 0.02, span_efficiency: 0.8", 0.1, {2, 0, 0});
  EXPECT_NEAR(F.y(), q_A * C_L, rounding_N);
  EXPECT_NEAR(F.x(), -q_A * (0.02 + C_L * C_L / (std::numbers::pi * 0.8 * 3)), rounding_N);
  EXPECT_NEAR(F.z(), 0, rounding_N);
}

TEST(Fin, IsReversedAsternInEachKindOfFlow) {
  // The flow that comes from behind pushes the fin to the other side, and drags it along.
  for (const char* flow : {"flow: body", "flow: local"}) {
    const std::string keys = std::string("area_m2: 0.02, lift_slope: 3, drag_coefficient: 0, ") + flow;
    const sim::Vector3d ahead = force(keys, 0.1, {2, 0, 0}), astern = force(keys, 0.1, {-2, 0, 0});
    EXPECT_GT(ahead.y(), 1) << flow;
    EXPECT_LT(astern.y(), -1) << flow;
    EXPECT_LT(ahead.x(), 0) << flow;
    EXPECT_GT(astern.x(), 0) << flow;
  }
  const std::string published = "model: coefficients, coefficients: {Y: 5, N: -3}";
  EXPECT_NEAR(force(published, 0.1, {2, 0, 0}).y(), 5 * 4 * 0.1, rounding_N);
  EXPECT_NEAR(force(published, 0.1, {-2, 0, 0}).y(), -5 * 4 * 0.1, rounding_N);
}

TEST(Fin, OfTheSpeedOfTheBodyHasNoJumpWhereTheFlowIsFromTheSide) {
  const std::string keys = "area_m2: 0.02, lift_slope: 3, flow: body";
  EXPECT_NEAR(force(keys, 0.1, {0, 1, 0}).y(), 0, rounding_N);
  EXPECT_NEAR(force(keys, 0.1, {0.001, 1, 0}).y(), -force(keys, 0.1, {-0.001, 1, 0}).y(), 1e-6);
}

TEST(Fin, StallsSmoothlyIntoAPlate) {
  const std::string keys =
      "area_m2: 0.01, lift_slope: 3, drag_coefficient: 0, stall_deg: 15, stall_width_deg: 10, "
      "limit_deg: 90, plate_coefficient: 1.2";
  const double q_A = 0.5 * 1000 * 1 * 0.01;
  const auto lift = [&](double angle) { return force(keys, angle, {1, 0, 0}).y() / q_A; };
  EXPECT_NEAR(lift(15 * degree), 3 * 15 * degree, 1e-9);
  EXPECT_LT(lift(25 * degree), lift(15 * degree));
  for (const double angle : {25 * degree, 45 * degree, 80 * degree})
    EXPECT_NEAR(lift(angle), 1.2 * std::pow(std::sin(angle), 2) * std::cos(angle), 1e-9) << angle;
  EXPECT_NEAR(force(keys, 90 * degree, {1, 0, 0}).x() / q_A, -1.2, 1e-9);
  // Nowhere a jump: the steepest slope of C_L is below 10 per rad.
  double before = lift(0);
  for (double angle = degree; angle < 90 * degree; angle += degree) {
    const double now = lift(angle);
    EXPECT_LT(std::abs(now - before), 10 * degree) << angle;
    before = now;
  }
}

TEST(Fin, NeverPushesForward) {
  // Work of the water on a fin that moves through it at any angle is not positive.
  for (double heading = -180; heading < 180; heading += 7)
    for (double angle = -60; angle <= 60; angle += 10) {
      const sim::Vector3d v(std::cos(heading * degree), std::sin(heading * degree), 0);
      EXPECT_LE(force("limit_deg: 60, flow: local", angle * degree, v).dot(v), rounding_N) << heading << " " << angle;
    }
}

}  // namespace
