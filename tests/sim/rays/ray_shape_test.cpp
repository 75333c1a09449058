// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rays/ray_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using sim::RayPacket;
using sim::RayShape;
using sim::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A shape at (5, 0, 0) with the axes of the world.
RayShape shape_of(RayShape::Kind kind, const std::array<double, 3>& size) {
  RayShape shape;
  shape.kind = kind;
  shape.center = {5, 0, 0};
  shape.axes = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  shape.size = size;
  shape.category = 1;
  return shape;
}

RayShape round(RayShape::Kind kind, double radius_m, double half_m) {
  return shape_of(kind, {radius_m, radius_m * radius_m, half_m});
}

/// The range of one ray; all lanes have it, and each must give the same.
double range_m(const RayShape& shape, const Vector3d& from, const Vector3d& direction) {
  RayPacket rays;
  for (int lane = 0; lane < RayPacket::size; ++lane) rays.set(lane, from, direction, 100);
  double alone[RayPacket::size], all[RayPacket::size];
  sim::find_ranges(shape, rays, 1, alone);
  sim::find_ranges(shape, rays, 0xff, all);
  for (const double each : all) EXPECT_EQ(each, alone[0]);
  return alone[0];
}

TEST(RayShape, RaysEnterBoxesSpheresAndCylindersAtTheirSurface) {
  const RayShape box = shape_of(RayShape::Kind::box, {1, 2, 3});
  EXPECT_DOUBLE_EQ(range_m(box, {0, 0, 0}, Vector3d::UnitX()), 4);
  EXPECT_DOUBLE_EQ(range_m(box, {5, 0, 10}, -Vector3d::UnitZ()), 7);
  EXPECT_EQ(range_m(box, {0, 2.1, 0}, Vector3d::UnitX()), infinity);
  EXPECT_DOUBLE_EQ(range_m(round(RayShape::Kind::sphere, 1, 0), {0, 0.6, 0}, Vector3d::UnitX()), 5 - 0.8);
  const RayShape cylinder = round(RayShape::Kind::cylinder, 1, 2);
  EXPECT_DOUBLE_EQ(range_m(cylinder, {0, 0.6, 1.9}, Vector3d::UnitX()), 5 - 0.8);
  EXPECT_EQ(range_m(cylinder, {0, 0, 2.1}, Vector3d::UnitX()), infinity);
  EXPECT_DOUBLE_EQ(range_m(cylinder, {5.5, 0, 9}, -Vector3d::UnitZ()), 7);
}

TEST(RayShape, ACapsuleHasRoundEnds) {
  const RayShape capsule = round(RayShape::Kind::capsule, 1, 2);
  EXPECT_DOUBLE_EQ(range_m(capsule, {5, 0, 9}, -Vector3d::UnitZ()), 6);
  EXPECT_DOUBLE_EQ(range_m(capsule, {0, 0, 2.6}, Vector3d::UnitX()), 5 - 0.8);
}

TEST(RayShape, FromInsideARayEndsWhereItLeaves) {
  EXPECT_DOUBLE_EQ(range_m(shape_of(RayShape::Kind::box, {1, 2, 3}), {5, 0, 0}, Vector3d::UnitY()), 2);
  EXPECT_DOUBLE_EQ(range_m(round(RayShape::Kind::sphere, 2, 0), {6, 0, 0}, Vector3d::UnitX()), 1);
}

TEST(RayShape, BehindTheOriginNothingIsHit) {
  EXPECT_EQ(range_m(round(RayShape::Kind::sphere, 1, 0), {10, 0, 0}, Vector3d::UnitX()), infinity);
}

TEST(RayShape, ReachAndExtentsHoldAllOfIt) {
  EXPECT_DOUBLE_EQ(shape_of(RayShape::Kind::box, {2, 3, 6}).reach_m(), 7);
  EXPECT_DOUBLE_EQ(round(RayShape::Kind::capsule, 1, 2).reach_m(), 3);
  EXPECT_DOUBLE_EQ(round(RayShape::Kind::cylinder, 3, 4).reach_m(), 5);
  RayShape cylinder = round(RayShape::Kind::cylinder, 1, 2);
  EXPECT_TRUE(cylinder.half_extents_W().isApprox(Vector3d(1, 1, 2)));
  // Lying along x.
  cylinder.axes = {0, 0, -1, 0, 1, 0, 1, 0, 0};
  EXPECT_TRUE(cylinder.half_extents_W().isApprox(Vector3d(2, 1, 1)));
}

TEST(RayShape, NormalsPointOutwards) {
  const RayShape cylinder = round(RayShape::Kind::cylinder, 1, 2);
  EXPECT_TRUE(sim::normal_at(cylinder, {6, 0, 0.5}).isApprox(Vector3d(1, 0, 0)));
  EXPECT_TRUE(sim::normal_at(cylinder, {5.2, 0, -2}).isApprox(Vector3d(0, 0, -1)));
  const RayShape capsule = round(RayShape::Kind::capsule, 1, 2);
  EXPECT_TRUE(sim::normal_at(capsule, {5, 0, 3}).isApprox(Vector3d(0, 0, 1)));
  EXPECT_TRUE(sim::normal_at(round(RayShape::Kind::sphere, 1, 0), {5, -1, 0}).isApprox(Vector3d(0, -1, 0)));
}

TEST(RayPacket, AtEqualRangeTheLowerPartCounts) {
  RayPacket rays;
  rays.set(0, Vector3d::Zero(), Vector3d::UnitX(), 10);
  RayShape shape = round(RayShape::Kind::sphere, 1, 0);
  shape.part = 5;
  EXPECT_TRUE(rays.nearer(0, 4, 5));
  rays.hit(0, 4, shape);
  EXPECT_FALSE(rays.nearer(0, 4, 6));
  EXPECT_TRUE(rays.nearer(0, 4, 3));
  EXPECT_TRUE(rays.nearer(0, 3.9, 9));
  EXPECT_FALSE(rays.nearer(0, 4.1, 0));
}

}  // namespace
