// SPDX-License-Identifier: BSD-3-Clause
// Meshes as parts of an Embree scene, without a physics world around them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "sim/geometry/mesh.hpp"
#include "sim/ode/ode_library.hpp"
#include "sim/rays/world_scene.hpp"

namespace {

using sim::Mesh;
using sim::RayHit;
using sim::Vector3d;

/// A field of `cells` x `cells` squares of a meter, two triangles each, the first corner at `corner`.
Mesh field(int cells, const Vector3d& corner, double slope) {
  Mesh mesh;
  for (int row = 0; row <= cells; ++row)
    for (int column = 0; column <= cells; ++column)
      mesh.vertices_m.push_back(corner + Vector3d(column, row, slope * column));
  const auto number = [&](int row, int column) { return static_cast<std::uint32_t>(row * (cells + 1) + column); };
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column) {
      mesh.triangles.push_back({number(row, column), number(row, column + 1), number(row + 1, column + 1)});
      mesh.triangles.push_back({number(row, column), number(row + 1, column + 1), number(row + 1, column)});
    }
  return mesh;
}

/// One mesh, at the pose of a geom whose shape does not count.
struct OneMesh {
  explicit OneMesh(const Mesh& mesh, std::span<const int> materials = {}) {
    sim::start_ode();
    geom.reset(dCreateBox(nullptr, 1, 1, 1));
    scene = sim::make_world_scene(sim::RayLibrary::embree, moves);
    scene->add_group(0);
    scene->add_part(0, {geom.get(), 0, 1, 9, 0, false, &mesh, materials});
    scene->close_group(0);
  }
  RayHit down(double x, double y, double from_z = 10) const {
    return scene->cast({x, y, from_z}, {0, 0, -1}, 100, {}).value_or(RayHit{});
  }
  sim::SceneMoves moves;
  sim::GeomHandle geom;
  std::unique_ptr<sim::WorldScene> scene;
};

TEST(EmbreeMesh, HasNoGapsAtEdgesAndCorners) {
  const Mesh mesh = field(20, {0, 0, 0}, 0.25);
  const OneMesh one(mesh);
  for (double x = 0.25; x < 20; x += 0.25)
    for (double y = 0.25; y < 20; y += 0.25) {
      const RayHit hit = one.down(x, y);
      ASSERT_TRUE(hit.hit()) << x << " " << y;
      ASSERT_NEAR(hit.range_m, 10 - 0.25 * x, 1e-12);
      ASSERT_NEAR((hit.normal_W - Vector3d(-0.25, 0, 1).normalized()).norm(), 0, 1e-12);
    }
}

TEST(EmbreeMesh, ReportsTheMaterialOfTheTriangle) {
  const Mesh mesh = field(4, {0, 0, 0}, 0);
  std::vector<int> materials;
  for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i) materials.push_back(i);
  const OneMesh one(mesh, materials);
  EXPECT_EQ(one.down(0.75, 0.25).material, 0);
  EXPECT_EQ(one.down(0.25, 0.75).material, 1);
  EXPECT_EQ(one.down(3.75, 3.25).material, 30);
  // On edges and corners one of those that share it, the same in every packet.
  for (double x = 0.5; x < 4; x += 0.5) {
    const std::vector<sim::Ray> rays(7, {{x, x, 10}, {0, 0, -1}, 100});
    std::vector<RayHit> hits(7);
    one.scene->cast(rays, {}, hits);
    for (const RayHit& hit : hits) EXPECT_EQ(hit.material, one.down(x, x).material) << x;
  }
}

TEST(EmbreeMesh, WithoutMaterialsOfItsTrianglesIsOfThatOfThePart) {
  const Mesh mesh = field(1, {0, 0, 0}, 0);
  EXPECT_EQ(OneMesh(mesh).down(0.5, 0.25).material, 9);
}

TEST(EmbreeMesh, InCoordinatesOfAMapKeepsMillimeters) {
  const Vector3d corner(500000, 4500000, 250);
  const Mesh mesh = field(100, corner, 0.125);
  const OneMesh one(mesh);
  for (double x = 0.1; x < 100; x += 3.7) {
    const RayHit hit = one.down(corner.x() + x, corner.y() + 50.3, 300);
    ASSERT_TRUE(hit.hit());
    EXPECT_NEAR(hit.range_m, 50 - 0.125 * x, 1e-6);
  }
}

TEST(EmbreeMesh, MovesWithItsGeom) {
  const Mesh mesh = field(2, {-1, -1, 0}, 0);
  OneMesh one(mesh);
  EXPECT_EQ(one.down(0.3, 0.2).range_m, 10);
  dGeomSetPosition(one.geom.get(), 500000, 0, 2);
  ++one.moves.fixed;
  EXPECT_FALSE(one.down(0.3, 0.2).hit());
  EXPECT_EQ(one.down(500000.3, 0.2).range_m, 8);
}

TEST(EmbreeMesh, IsNotHurtByDegenerateTriangles) {
  Mesh mesh = field(2, {0, 0, 0}, 0);
  mesh.triangles.push_back({0, 0, 0});
  mesh.triangles.push_back({0, 1, 2});  // in a line
  mesh.triangles.push_back({4, 4, 8});
  const OneMesh one(mesh);
  for (const auto& [x, y] : {std::pair(0.5, 0.0), {1.0, 1.0}, {1.5, 1.5}, {0.3, 0.1}, {1.0, 0.0}}) {
    const RayHit hit = one.down(x, y + 1e-9);
    ASSERT_TRUE(hit.hit()) << x << " " << y;
    EXPECT_NEAR(hit.range_m, 10, 1e-12);
    EXPECT_NEAR((hit.normal_W - Vector3d::UnitZ()).norm(), 0, 1e-12) << x << " " << y;
  }
  // Along the surface, where most triangles are seen edge-on.
  const auto hit = one.scene->cast({-1, 0.5, 0}, {1, 0, 0}, 10, {});
  if (hit) {
    EXPECT_TRUE(hit->range_m >= 1 && hit->range_m <= 3);
  }
}

TEST(EmbreeMesh, EmptyStopsNoRay) {
  const Mesh mesh;
  EXPECT_FALSE(OneMesh(mesh).down(0, 0).hit());
}

TEST(EmbreeMesh, IsHitFromAPointOnIt) {
  const Mesh mesh = field(200, {0, 0, 0}, 0);
  const OneMesh one(mesh);
  // Less above and below than a float can tell at 100 m from the center of the mesh.
  for (const double height : {1e-9, 1e-7, 1e-6}) {
    const RayHit hit = one.down(3.3, 190.1, height);
    ASSERT_TRUE(hit.hit()) << height;
    EXPECT_NEAR(hit.range_m, height, 1e-12);
    EXPECT_FALSE(one.down(3.3, 190.1, -height).hit()) << height;
  }
}

}  // namespace
