// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/mass_of_shapes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <optional>

#include "sim/config/diagnostics.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/urdf/urdf_texts.hpp"
#include "tools/shoal/urdf/imported_meshes.hpp"

namespace {

using sim::Matrix3d;
using sim::Vector3d;
using std::numbers::pi;
using test::notes_of;
using test::robot_text;
using testing::HasSubstr;

std::string shape(const std::string& kind, const std::string& geometry, const std::string& origin = "") {
  return "<" + kind + ">" + origin + "<geometry>" + geometry + "</geometry></" + kind + ">";
}

/// A robot of one link without mass.
tools::ImportedVehicle of_shapes(const std::string& shapes, double density_kgpm3 = 1000) {
  tools::ImportedVehicle vehicle =
      tools::vehicle_of(tools::read_urdf(robot_text("<link name=\"a\">" + shapes + "</link>\n"), "r.urdf"), "r.urdf",
                        tools::Base::free, tools::NoMass::of_shapes);
  tools::complete_masses(vehicle, {}, density_kgpm3);
  return vehicle;
}

void expect_moments(const tools::ImportedBody& body, double mass_kg, const Vector3d& moments) {
  EXPECT_NEAR(body.mass_kg, mass_kg, 1e-9 * mass_kg);
  EXPECT_TRUE(body.inertia_kgm2.isApprox(Matrix3d(moments.asDiagonal()), 1e-9)) << body.inertia_kgm2;
}

TEST(MassOfShapes, IsThatOfEachShapeAtTheDensity) {
  const tools::ImportedVehicle box = of_shapes(shape("collision", "<box size=\"1 2 3\"/>"), 500);
  expect_moments(box.bodies[0], 3000, Vector3d(13, 10, 5) * 3000 / 12);
  EXPECT_EQ(notes_of(box),
            "r.urdf:2: body 'a': its mass is not given: it gets 3000 kg, that of its shapes at 500 kg/m^3\n");
  const double r = 0.2, length = 0.6;
  const double ball = 4.0 / 3 * pi * r * r * r * 1000, rod = pi * r * r * length * 1000;
  expect_moments(of_shapes(shape("collision", "<sphere radius=\"0.2\"/>")).bodies[0], ball,
                 Vector3d::Constant(0.4 * ball * r * r));
  const double across = rod * (r * r / 4 + length * length / 12);
  expect_moments(of_shapes(shape("collision", "<cylinder radius=\"0.2\" length=\"0.6\"/>")).bodies[0], rod,
                 {across, across, rod * r * r / 2});
  // Each half ball has its centroid 3/8 r from its flat side, and 83/320 m r^2 about it.
  const double half = ball / 2, arm = length / 2 + 3.0 / 8 * r;
  const double caps = 2 * (83.0 / 320 * half * r * r + half * arm * arm);
  expect_moments(of_shapes(shape("collision", "<capsule radius=\"0.2\" length=\"0.6\"/>")).bodies[0], rod + ball,
                 {across + caps, across + caps, rod * r * r / 2 + 0.4 * ball * r * r});
}

TEST(MassOfShapes, AddsShapesAtTheirPlaces) {
  // Two cubes of 1 kg with a side of 0.1 m, 1 m apart: two points more of 1 kg, 0.5 m from the middle.
  const tools::ImportedVehicle vehicle = of_shapes(
      shape("collision", "<box size=\"0.1 0.1 0.1\"/>", "<origin xyz=\"1 0 0\"/>") +
      shape("collision", "<box size=\"0.1 0.1 0.1\"/>", "<origin xyz=\"2 0 0\" rpy=\"0 0 1.5707963267948966\"/>"));
  EXPECT_TRUE(vehicle.bodies[0].center_of_mass_m.isApprox(Vector3d(1.5, 0, 0), 1e-12));
  const double own = 2 * 0.01 / 6;
  expect_moments(vehicle.bodies[0], 2, {own, own + 2 * 0.25, own + 2 * 0.25});
}

TEST(MassOfShapes, TakesVisualShapesOnlyWithoutOthers) {
  const std::string visual = shape("visual", "<box size=\"0.2 0.1 0.1\"/>");
  EXPECT_NEAR(of_shapes(visual).bodies[0].mass_kg, 2, 1e-12);
  EXPECT_NEAR(of_shapes(visual + shape("collision", "<box size=\"0.1 0.1 0.1\"/>")).bodies[0].mass_kg, 1, 1e-12);
  const tools::ImportedVehicle none = of_shapes("");
  EXPECT_NEAR(none.bodies[0].mass_kg, 4.0 / 3 * pi * 1e-6 * 1000, 1e-9);
  EXPECT_THAT(notes_of(none), HasSubstr("it gets 0.004189 kg, that of a ball of 10 mm radius at 1000 kg/m^3"));
}

TEST(MassOfShapes, OfAMeshIsThatOfItsConvexHull) {
  // A tetrahedron with legs of 1 m, whose surface is open: 1/6 m^3, and 1/80 m^5 about each axis through its centroid.
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("m.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
  const std::string path = folder.file("r.urdf");
  for (const std::string kind : {"collision", "visual"}) {
    const std::string link = "<link name=\"a\">" + shape(kind, "<mesh filename=\"m.obj\"/>") + "</link>";
    tools::ImportedVehicle vehicle =
        tools::vehicle_of(tools::read_urdf(robot_text(link), path), path, tools::Base::free, tools::NoMass::of_shapes);
    const std::vector<tools::MeshFile> meshes = tools::convert_meshes(vehicle, {});
    tools::complete_masses(vehicle, meshes, 600);
    EXPECT_NEAR(vehicle.bodies[0].mass_kg, 100, 1e-6);
    EXPECT_TRUE(vehicle.bodies[0].center_of_mass_m.isApprox(Vector3d::Constant(0.25), 1e-6));
    EXPECT_NEAR(vehicle.bodies[0].inertia_kgm2(0, 0), 600 / 80.0, 1e-6);
  }
}

TEST(MassOfShapes, GivesAnInertiaOfZeroThatOfTheShapesWithTheMass) {
  const auto body = [](const std::string& inertia, const std::string& shapes) {
    tools::ImportedVehicle vehicle =
        test::imported(robot_text("<link name=\"a\"><inertial><origin xyz=\"0 0 0.3\"/><mass value=\"2\"/><inertia " +
                                  inertia + "/></inertial>" + shapes + "</link>\n"));
    tools::complete_masses(vehicle, {});
    return vehicle;
  };
  const std::string box = shape("collision", "<box size=\"1 2 3\"/>");
  const std::string zero = "its inertia is zero",
                    needle = "no solid has its inertia, with the moments 0, 0.1 and 0.1 kg m^2";
  for (const auto& [inertia, fault] :
       std::vector<std::pair<std::string, std::string>>{{"ixx=\"0\" iyy=\"0\" izz=\"0\"", zero},
                                                        {"ixx=\"1e-20\" ixy=\"-1e-19\" iyy=\"-5e-20\" izz=\"0\"", zero},
                                                        {"ixx=\"0\" iyy=\"0.1\" izz=\"0.1\"", needle}}) {
    const tools::ImportedVehicle vehicle = body(inertia, box);
    expect_moments(vehicle.bodies[0], 2, Vector3d(13, 10, 5) * 2 / 12);
    EXPECT_EQ(vehicle.bodies[0].center_of_mass_m, Vector3d(0, 0, 0.3));
    EXPECT_EQ(notes_of(vehicle), "r.urdf:2: body 'a': " + fault + ": it gets that of its shapes with its mass\n");
  }
  // Without shapes: a ball of water.  m = 4/3 pi r^3 1000.
  const tools::ImportedVehicle bare = body("ixx=\"0\" iyy=\"0\" izz=\"0\"", "");
  const double r = std::cbrt(2 / (4.0 / 3 * pi * 1000));
  expect_moments(bare.bodies[0], 2, Vector3d::Constant(0.4 * 2 * r * r));
}

using sim::Vector3d;

TEST(ConvexHull, OfABoxHasTwelveTriangles) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 8; ++i) points.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  points.emplace_back(0.5, 0.5, 0.5);  // inside
  const std::optional<sim::Mesh> hull = tools::convex_hull(points);
  ASSERT_TRUE(hull);
  EXPECT_EQ(hull->vertices_m.size(), 8u);
  EXPECT_EQ(hull->triangles.size(), 12u);
  EXPECT_NEAR(sim::solid_of(*hull).volume_m3, 1, 1e-12);
}

TEST(ConvexHull, OfPointsOnASphereHasTwiceAsManyTrianglesLessFour) {
  // Euler: 2 n - 4 triangles of n points in general position on a convex surface.
  std::vector<Vector3d> points;
  for (int i = 0; i < 500; ++i)
    points.push_back(Vector3d(std::sin(7.1 * i + 1), std::sin(3.3 * i * i), std::cos(1.7 * i)).normalized());
  const std::optional<sim::Mesh> hull = tools::convex_hull(points);
  ASSERT_TRUE(hull);
  EXPECT_EQ(hull->vertices_m.size(), 500u);
  EXPECT_EQ(hull->triangles.size(), 996u);
  EXPECT_TRUE(sim::is_closed(*hull));
  for (const auto& t : hull->triangles) {
    const Vector3d &a = hull->vertices_m[t[0]], &b = hull->vertices_m[t[1]], &c = hull->vertices_m[t[2]];
    const Vector3d normal = (b - a).cross(c - a).normalized();
    for (const Vector3d& p : points) ASSERT_LE(normal.dot(p - a), 1e-8);
  }
}

TEST(ConvexHull, OfPointsInAPlaneIsNone) {
  EXPECT_FALSE(tools::convex_hull({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5, 0.3, 1}}));
  EXPECT_FALSE(tools::convex_hull({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}));
  EXPECT_FALSE(tools::convex_hull({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
}

TEST(ConvexHull, OutermostPointsKeepTheBoundingBox) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 5000; ++i)
    points.emplace_back(std::sin(7.1 * i), 0.01 * std::sin(3.3 * i), 3 * std::cos(1.7 * i));
  const std::vector<Vector3d> outermost = tools::outermost_points(points);
  EXPECT_LE(outermost.size(), 262u);
  const auto extent = [](const std::vector<Vector3d>& all, int axis) {
    const auto [low, high] = std::minmax_element(
        all.begin(), all.end(), [&](const Vector3d& a, const Vector3d& b) { return a[axis] < b[axis]; });
    return (*high)[axis] - (*low)[axis];
  };
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(extent(outermost, axis), extent(points, axis));
}

}  // namespace
