// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/ray_casting.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace {

TEST(BeamPattern, OfOneRayOrNoAngleIsItsAxis) {
  EXPECT_THAT(devices::cone_pattern(0.3, 1), testing::ElementsAre(sim::Vector3d(1, 0, 0)));
  EXPECT_THAT(devices::cone_pattern(0, 100), testing::ElementsAre(sim::Vector3d(1, 0, 0)));
}

TEST(BeamPattern, RaysShareTheConeInEqualSolidAngles) {
  const double half_angle_rad = 0.3;
  const auto rays = devices::cone_pattern(half_angle_rad, 1000);
  ASSERT_EQ(rays.size(), 1000u);
  int inner = 0;
  sim::Vector3d sum = sim::Vector3d::Zero();
  // The inner cone with half of the solid angle.
  const double middle_cosine = (1 + std::cos(half_angle_rad)) / 2;
  for (const sim::Vector3d& ray : rays) {
    EXPECT_NEAR(ray.norm(), 1, 1e-12);
    EXPECT_GE(ray.x(), std::cos(half_angle_rad));
    inner += ray.x() > middle_cosine;
    sum += ray;
  }
  EXPECT_EQ(inner, 500);
  EXPECT_NEAR(sum.y() / 1000, 0, 1e-3);  // around the axis
  EXPECT_NEAR(sum.z() / 1000, 0, 1e-3);
}

TEST(BeamPattern, AHalfSpaceIsTwoPi) {
  EXPECT_NEAR(devices::cone_solid_angle_sr(std::numbers::pi / 2), 2 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(devices::cone_solid_angle_sr(std::numbers::pi), 4 * std::numbers::pi, 1e-12);
  EXPECT_EQ(devices::cone_solid_angle_sr(0), 0);
}

}  // namespace
