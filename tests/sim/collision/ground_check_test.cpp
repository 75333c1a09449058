// SPDX-License-Identifier: BSD-3-Clause
#include "sim/collision/ground_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/sim/terrain/terrain_worlds.hpp"

namespace {

using namespace terrain_worlds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// What is said of a wheel, or a box, of this geom on a level ground.
std::vector<std::string> said_of(const sim::GeomHandle& geom, bool wheel, double cell_m, TerrainCollision collision,
                                 bool hard = false) {
  const sim::ContactTable table({}, {});
  sim::MeshCache meshes;
  const sim::CollisionTerrain ground(level_ground(cell_m, collision), "ground", table, meshes);
  return sim::warnings_about(ground, {geom.get(), wheel, hard});
}

sim::GeomHandle sphere_of(double radius_m) {
  sim::start_ode();
  return sim::GeomHandle(dCreateSphere(nullptr, radius_m));
}

TEST(GroundCheck, WarnsOfWheelsMuchLargerThanSmoothCells) {
  EXPECT_THAT(said_of(sphere_of(1), true, 0.24, TerrainCollision::smooth),
              ElementsAre(HasSubstr("bumps may be missed")));
  EXPECT_THAT(said_of(sphere_of(1), true, 0.26, TerrainCollision::smooth), IsEmpty());
  EXPECT_THAT(said_of(sphere_of(1), false, 0.24, TerrainCollision::smooth), IsEmpty()) << "not a wheel";
}

TEST(GroundCheck, WarnsOfWheelsOnFacetsThatAreSmallOrHard) {
  EXPECT_THAT(said_of(sphere_of(0.5), true, 1.1, TerrainCollision::facets), IsEmpty());
  EXPECT_THAT(said_of(sphere_of(0.5), true, 0.9, TerrainCollision::facets),
              ElementsAre(HasSubstr("smaller than a wheel")));
  EXPECT_THAT(said_of(sphere_of(0.5), true, 1.1, TerrainCollision::facets, true), ElementsAre(HasSubstr("soft_cfm")));
}

TEST(GroundCheck, WarnsOfBoxesThatCoverMoreThan64Facets) {
  sim::start_ode();
  // A box of 8.1 m by 8.1 m on cells of 1 m covers 65.6 of them; its height does not count.
  EXPECT_THAT(said_of(sim::GeomHandle(dCreateBox(nullptr, 8.1, 8.1, 0.5)), false, 1, TerrainCollision::facets),
              ElementsAre(HasSubstr("covers many facets")));
  EXPECT_THAT(said_of(sim::GeomHandle(dCreateBox(nullptr, 7.9, 7.9, 0.5)), false, 1, TerrainCollision::facets),
              IsEmpty());
}

TEST(GroundCheck, WarnsOfCylindersAsWheelsOnTriangles) {
  sim::start_ode();
  EXPECT_THAT(said_of(sim::GeomHandle(dCreateCylinder(nullptr, 0.5, 0.2)), true, 1, TerrainCollision::mesh),
              ElementsAre(HasSubstr("a dozen contacts")));
  EXPECT_THAT(said_of(sphere_of(0.5), true, 1, TerrainCollision::mesh), IsEmpty());
}

TEST(GroundCheck, TakesSpheresAndCylindersForPartsOfWheels) {
  sim::start_ode();
  EXPECT_TRUE(sim::is_round(sphere_of(1).get()));
  EXPECT_TRUE(sim::is_round(sim::GeomHandle(dCreateCylinder(nullptr, 1, 1)).get()));
  EXPECT_FALSE(sim::is_round(sim::GeomHandle(dCreateBox(nullptr, 1, 1, 1)).get()));
}

}  // namespace
