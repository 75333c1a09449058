// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "sim/collision/terrain_geom.hpp"
#include "sim/ode/ode_math.hpp"
#include "tests/sim/terrain/terrain_worlds.hpp"

namespace {

using namespace terrain_worlds;
using sim::GeomHandle;

/// A terrain's geom alone, and what touches it.
class Ground {
 public:
  explicit Ground(const PartConfig& part) : terrain_((sim::start_ode(), part), "ground", table_, meshes_) {
    geom_ = sim::make_terrain_geom(terrain_);
  }
  std::vector<dContactGeom> touch(dGeomID other, int max = 8) const {
    std::vector<dContactGeom> contacts(static_cast<std::size_t>(max));
    // As the world's collider asks: the ground may be the first or the second.
    contacts.resize(static_cast<std::size_t>(dCollide(geom_.get(), other, max, contacts.data(), sizeof(dContactGeom))));
    return contacts;
  }
  dGeomID geom() const { return geom_.get(); }
  const sim::HeightGrid& grid() const { return terrain_.terrain.grid; }

 private:
  sim::ContactTable table_{{}, {}};
  sim::MeshCache meshes_;
  sim::CollisionTerrain terrain_;
  GeomHandle geom_;
};

PartConfig slope(double angle_rad, double cell_m, TerrainCollision collision = TerrainCollision::smooth) {
  PartConfig part = level_ground(cell_m, collision);
  part.terrain->angle_rad = angle_rad;
  return part;
}

GeomHandle placed(dGeomID geom, const Vector3d& p, const Vector3d& rpy_rad = Vector3d::Zero()) {
  dMatrix3 R;
  sim::to_ode(sim::rotation_from_rpy(rpy_rad), R);
  dGeomSetPosition(geom, p.x(), p.y(), p.z());
  dGeomSetRotation(geom, R);
  return GeomHandle(geom);
}

constexpr double right_angle = std::numbers::pi / 2;

TEST(SmoothGround, SphereOnASlopeTouchesOnceAlongTheNormal) {
  const double angle = 0.3, r = 0.4, sunk = 0.01;
  const Ground ground(slope(angle, 0.25));
  const Vector3d normal(-std::sin(angle), 0, std::cos(angle));
  const Vector3d foot(1.234, -0.77, 1.234 * std::tan(angle));
  const GeomHandle ball = placed(dCreateSphere(nullptr, r), foot + (r - sunk) * normal);
  const auto contacts = ground.touch(ball.get());
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].depth, sunk, 1e-12);
  EXPECT_TRUE((sim::to_eigen(contacts[0].normal) + normal).norm() < 1e-12);  // into the first geom, the ground
  EXPECT_TRUE((sim::to_eigen(contacts[0].pos) - (foot - sunk * normal)).norm() < 1e-12);
  EXPECT_EQ(contacts[0].g1, ground.geom());
  // Asked the other way round ODE turns it over.
  dContactGeom turned;
  ASSERT_EQ(dCollide(ball.get(), ground.geom(), 1, &turned, sizeof turned), 1);
  EXPECT_TRUE((sim::to_eigen(turned.normal) - normal).norm() < 1e-12);
  EXPECT_EQ(turned.g1, ball.get());
}

TEST(SmoothGround, SphereOnWavesTouchesTheNearestPoint) {
  const Ground ground(waves(0.1, TerrainCollision::smooth, 0.3, 3));
  for (const double x : {0.0, 0.4, 0.75, 1.3, 2.2}) {
    const GeomHandle ball = placed(dCreateSphere(nullptr, 0.35), {x, 0.2, ground.grid().height(x, 0.2) + 0.3});
    const auto contacts = ground.touch(ball.get());
    // By trying places 0.1 mm apart, which is exact to the square of that.
    double nearest = 1e9;
    for (double u = x - 1; u < x + 1; u += 1e-4)
      nearest = std::min(nearest, std::hypot(u - x, ground.grid().height(u, 0.2) - ground.grid().height(x, 0.2) - 0.3));
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(contacts[0].depth, 0.35 - nearest, 1e-7);
  }
}

TEST(SmoothGround, WhatSankDeepIsPushedUpAndOut) {
  const Ground ground(slope(0.2, 0.5));
  for (const double below_m : {0.05, 0.5, 3.0, 50.0}) {
    const GeomHandle ball = placed(dCreateSphere(nullptr, 0.1), {1, 1, std::tan(0.2) - below_m});
    const auto contacts = ground.touch(ball.get());
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(contacts[0].depth, 0.1 + below_m * std::cos(0.2), 1e-9);
    EXPECT_LT(contacts[0].normal[2], -0.9);
  }
}

TEST(SmoothGround, WheelStandsOnItsTwoRimsAndCylinderOnFourPlacesOfItsEnd) {
  const Ground ground(level_ground(0.25));
  const GeomHandle wheel = placed(dCreateCylinder(nullptr, 0.35, 0.2), {0.3, 0.1, 0.345}, {right_angle, 0, 0.4});
  const auto two = ground.touch(wheel.get());
  ASSERT_EQ(two.size(), 2u);
  for (const auto& contact : two) {
    EXPECT_NEAR(contact.depth, 0.005, 1e-12);
    EXPECT_NEAR(std::hypot(contact.pos[0] - 0.3, contact.pos[1] - 0.1), 0.1, 1e-12);
  }
  const GeomHandle drum = placed(dCreateCylinder(nullptr, 0.35, 0.2), {0.3, 0.1, 0.095});
  const auto four = ground.touch(drum.get());
  ASSERT_EQ(four.size(), 4u);
  for (const auto& contact : four) EXPECT_NEAR(contact.depth, 0.005, 1e-12);
  const GeomHandle capsule = placed(dCreateCapsule(nullptr, 0.35, 2), {0.3, 0.1, 0.345}, {right_angle, 0, 0});
  EXPECT_EQ(ground.touch(capsule.get()).size(), 2u);
  const GeomHandle box = placed(dCreateBox(nullptr, 4, 2, 0.5), {0.3, 0.1, 0.245});
  EXPECT_EQ(ground.touch(box.get()).size(), 4u);
}

TEST(SmoothGround, WheelOnAHillTouchesWhereItsRimIsDeepest) {
  const Ground ground(waves(0.1, TerrainCollision::smooth, 0.3, 3));
  const double x = 0.5, r = 0.35, z = ground.grid().height(x, 0) + 0.32;
  const GeomHandle wheel = placed(dCreateCylinder(nullptr, r, 0.2), {x, 0, z}, {right_angle, 0, 0});
  double deepest = -1;
  for (double a = 0; a < 2 * std::numbers::pi; a += 1e-4) {
    const auto surface = ground.grid().smooth_at(x + r * std::cos(a), 0);
    deepest = std::max(deepest, (surface.height_m - z - r * std::sin(a)) * surface.normal().z());
  }
  for (const auto& contact : ground.touch(wheel.get())) EXPECT_NEAR(contact.depth, deepest, 1e-5);
}

TEST(SmoothGround, ABoxMeetsTheBumpUnderItsMiddle) {
  PartConfig part = level_ground(0.5);
  part.terrain->source = TerrainSource::sine;
  part.terrain->amplitude_m = 0.2;
  part.terrain->wavelength_m = 4;
  const Ground ground(part);
  const double crest = ground.grid().height(1, 0);
  const GeomHandle box = placed(dCreateBox(nullptr, 2, 1, 0.4), {1, 0, crest + 0.2 - 0.01});
  const auto contacts = ground.touch(box.get());
  ASSERT_GE(contacts.size(), 2u);
  EXPECT_NEAR(contacts[0].depth, 0.01, 1e-4);
  for (const auto& contact : contacts) EXPECT_NEAR(contact.pos[0], 1, 0.5);
}

TEST(SmoothGround, ABoxMissesWhatIsFinerThanSevenPointsBelowIt) {
  PartConfig part = level_ground(0.02);
  part.terrain->size_m = {4, 4};
  part.terrain->source = TerrainSource::sine;
  part.terrain->amplitude_m = 0.05;
  part.terrain->wavelength_m = 1.0 / 3;  // the spacing of seven points along 2 m
  const Ground ground(part);
  double trough_m = 0;
  for (double x = -0.2; x < 0.2; x += 0.01)
    if (ground.grid().height(x, 0) < ground.grid().height(trough_m, 0)) trough_m = x;
  ASSERT_NEAR(ground.grid().height(trough_m, 0), -0.05, 0.002);
  // The crests reach 5 cm into the box.
  EXPECT_TRUE(ground.touch(placed(dCreateBox(nullptr, 2, 1, 0.4), {trough_m, 0, 0.2}).get()).empty());
}

TEST(SmoothGround, ContactsAreBoundedForAnySizeOfCells) {
  for (const double cell_m : {0.05, 0.2, 1.0}) {
    PartConfig part = level_ground(cell_m);
    part.terrain->source = TerrainSource::fractal;
    part.terrain->wavelength_m = 4;
    part.terrain->amplitude_m = 0.5;
    const Ground ground(part);
    const GeomHandle box = placed(dCreateBox(nullptr, 8, 6, 1), {0.3, 0.1, -1});
    EXPECT_EQ(ground.touch(box.get(), 8).size(), 8u);
    EXPECT_LE(ground.touch(box.get(), 256).size(), 80u);
    EXPECT_EQ(ground.touch(box.get(), 1).size(), 1u);
  }
}

TEST(SmoothGround, BesideTheTerrainIsNothing) {
  const Ground ground(level_ground(1));
  const GeomHandle ball = placed(dCreateSphere(nullptr, 0.5), {10.6, 0, 0});
  EXPECT_TRUE(ground.touch(ball.get()).empty());
}

TEST(SmoothGround, IsPlacedAndTurnedLikeAnyGeom) {
  const Ground ground(slope(0.2, 0.5));
  const Pose X_WT = sim::make_pose({5, -3, 2}, {0.1, -0.2, 0.7});
  placed(ground.geom(), X_WT.translation(), {0.1, -0.2, 0.7}).release();
  const Vector3d normal_T(-std::sin(0.2), 0, std::cos(0.2));
  const GeomHandle ball =
      placed(dCreateSphere(nullptr, 0.3), X_WT * (Vector3d(2, 1, 2 * std::tan(0.2)) + 0.29 * normal_T));
  const auto contacts = ground.touch(ball.get());
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].depth, 0.01, 1e-12);
  EXPECT_TRUE((sim::to_eigen(contacts[0].normal) + X_WT.linear() * normal_T).norm() < 1e-12);
}

TEST(FacetGround, OdesHeightfieldHasTheSameTriangles) {
  PartConfig part = level_ground(0.5, TerrainCollision::facets);
  part.terrain->source = TerrainSource::fractal;
  part.terrain->wavelength_m = 5;
  const Ground ground(part);
  placed(ground.geom(), {1, 2, 3}, {0, 0, 0.5}).release();
  const Pose X_WT = sim::make_pose({1, 2, 3}, {0, 0, 0.5});
  for (const auto& [x, y] : {std::pair{0.3, 0.1}, {-2.15, 4.4}, {3.4, -3.3}, {1.9, 1.7}}) {
    // So small a sphere meets one triangle.
    const GeomHandle ball =
        placed(dCreateSphere(nullptr, 0.01), X_WT * Vector3d(x, y, ground.grid().facet_height(x, y)));
    const auto contacts = ground.touch(ball.get());
    ASSERT_EQ(contacts.size(), 1u) << x;
    EXPECT_NEAR(contacts[0].depth, 0.01, 1e-9);
    EXPECT_EQ(contacts[0].g1, ground.geom());
  }
}

}  // namespace
