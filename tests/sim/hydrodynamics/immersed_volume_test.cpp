// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/immersed_volume.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <functional>
#include <numbers>

#include "sim/hydrodynamics/immersed_piece.hpp"
#include "tests/fidelity/closed_forms.hpp"

namespace sim {
namespace {

using std::numbers::pi;
using test::expect_closed_form;

Mesh box_mesh(const Vector3d& size) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_m.push_back(Vector3d(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5).cwiseProduct(size));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Vector3d random_direction() {
  const double turn = *rc::gen::inRange(0, 6283) / 1000.0, z = *rc::gen::inRange(-1000, 1001) / 1000.0;
  const double level = std::sqrt(1 - z * z);
  return {level * std::cos(turn), level * std::sin(turn), z};
}

double random_between(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 100001) / 100000.0;
}

TEST(ImmersedVolume, OfASphereIsThatOfACap) {
  const ImmersedVolume cap = immersed_sphere(0.3, {Vector3d::UnitZ(), 0.18 - 0.3});
  expect_closed_form(cap.volume_m3, "sphere_immersed_volume", "depth_of_immersion=0.18", "volume");
  expect_closed_form(cap.centroid_m.z(), "sphere_immersed_volume", "depth_of_immersion=0.18",
                     "centroid_z_above_sphere_centre");
}

TEST(ImmersedVolume, OfACapsuleLyingAndStanding) {
  const RoundSolid capsule{0.095, 0.7, true, -0.795, 0.795};
  expect_closed_form(immersed_round(capsule, {Vector3d::UnitX(), 0.0665 - 0.095}).volume_m3,
                     "capsule_horizontal_immersed", "", "volume");
  expect_closed_form(immersed_round(capsule, {Vector3d::UnitZ(), 0.6 - 0.795}).volume_m3, "capsule_vertical_immersed",
                     "", "volume");
}

/// What the sums should agree with: the solid cut into small cubes.
ImmersedVolume by_voxels(const Vector3d& half, const std::function<bool(const Vector3d&)>& inside,
                         const WaterPlane& plane) {
  constexpr int n = 60;
  ImmersedVolume sum;
  const Vector3d cell = 2 * half / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const Vector3d p = Vector3d(i + 0.5, j + 0.5, k + 0.5).cwiseProduct(cell) - half;
        if (!inside(p) || plane.normal.dot(p) >= plane.level_m) continue;
        sum.volume_m3 += cell.prod();
        sum.centroid_m += cell.prod() * p;
      }
  if (sum.volume_m3 > 0) sum.centroid_m /= sum.volume_m3;
  return sum;
}

void expect_same(const ImmersedVolume& a, const ImmersedVolume& b, double volume, double size) {
  // Cubes of 1/60 of the size: the error of a surface of random position is some cells of its area.
  RC_ASSERT(std::abs(a.volume_m3 - b.volume_m3) < 0.015 * volume);
  if (b.volume_m3 > 0.1 * volume) RC_ASSERT((a.centroid_m - b.centroid_m).norm() < 0.015 * size);
}

RC_GTEST_PROP(ImmersedVolume, AgreesWithSmallCubes, ()) {
  const WaterPlane plane{random_direction(), random_between(-0.6, 0.6)};
  const RoundSolid cylinder{0.3, 0.5, false, -0.5, 0.5}, capsule{0.3, 0.4, true, -0.7, 0.7};
  expect_same(immersed_round(cylinder, plane),
              by_voxels(
                  {0.3, 0.3, 0.5}, [](const Vector3d& p) { return std::hypot(p.x(), p.y()) < 0.3; }, plane),
              pi * 0.09, 1);
  expect_same(immersed_round(capsule, plane),
              by_voxels(
                  {0.3, 0.3, 0.7},
                  [](const Vector3d& p) {
                    const double over = std::max(0.0, std::abs(p.z()) - 0.4);
                    return p.x() * p.x() + p.y() * p.y() + over * over < 0.09;
                  },
                  plane),
              pi * 0.09 * 1.2, 1.4);
  const Vector3d size(0.8, 0.5, 0.3);
  expect_same(immersed_box(size, plane),
              by_voxels(
                  size / 2, [](const Vector3d&) { return true; }, plane),
              size.prod(), 0.8);
}

RC_GTEST_PROP(ImmersedVolume, OfABoxIsThatOfItsMesh, ()) {
  const Vector3d size(random_between(0.1, 2), random_between(0.1, 2), random_between(0.1, 2));
  const WaterPlane plane{random_direction(), random_between(-1, 1)};
  const ImmersedVolume box = immersed_box(size, plane), mesh = immersed_mesh(box_mesh(size), plane);
  RC_ASSERT(std::abs(box.volume_m3 - mesh.volume_m3) < 1e-12);
  RC_ASSERT((box.volume_m3 * box.centroid_m - mesh.volume_m3 * mesh.centroid_m).norm() < 1e-12);
}

RC_GTEST_PROP(ImmersedVolume, OfSectionsAddsUp, ()) {
  const WaterPlane plane{random_direction(), random_between(-1, 1)};
  const Mesh mesh = box_mesh({1.5, 0.6, 0.4});
  const ImmersedVolume whole = immersed_mesh(mesh, plane);
  double volume = 0;
  Vector3d moment = Vector3d::Zero();
  for (int i = 0; i < 5; ++i) {
    const ImmersedVolume part = immersed_mesh(section_of(mesh, 0, -0.75 + 0.3 * i, -0.45 + 0.3 * i), plane);
    volume += part.volume_m3;
    moment += part.volume_m3 * part.centroid_m;
  }
  RC_ASSERT(std::abs(volume - whole.volume_m3) < 1e-12);
  RC_ASSERT((moment - whole.volume_m3 * whole.centroid_m).norm() < 1e-12);
}

/// The buoyancy of any shape is the slope of a potential: dV/d(level) is the area of the water plane.
RC_GTEST_PROP(ImmersedVolume, IsContinuousThroughTheSurface, ()) {
  const RoundSolid cylinder{0.3, 0.5, false, -0.5, 0.5}, capsule{0.3, 0.4, true, -0.7, 0.7};
  const Vector3d size(0.8, 0.5, 0.3);
  const Vector3d normal =
      *rc::gen::arbitrary<bool>() ? random_direction() : Vector3d(Vector3d::Unit(*rc::gen::inRange(0, 3)));
  const std::function<ImmersedVolume(const WaterPlane&)> shapes[] = {
      [](const WaterPlane& plane) { return immersed_sphere(0.4, plane); },
      [&](const WaterPlane& plane) { return immersed_box(size, plane); },
      [&](const WaterPlane& plane) { return immersed_round(cylinder, plane); },
      [&](const WaterPlane& plane) { return immersed_round(capsule, plane); }};
  for (const auto& shape : shapes) {
    ImmersedVolume last = shape({normal, -0.8});
    RC_ASSERT(last.volume_m3 == 0);
    // The largest cut is the capsule's, 0.6 x 1.4; moments are of points within 0.8 m.
    constexpr double step = 0.001, max_cut = 0.85;
    for (double level = -0.8; level < 0.8; level += step) {
      const ImmersedVolume now = shape({normal, level});
      RC_ASSERT(now.volume_m3 - last.volume_m3 > -1e-6);
      RC_ASSERT(now.volume_m3 - last.volume_m3 < max_cut * step * 1.01);
      RC_ASSERT((now.volume_m3 * now.centroid_m - last.volume_m3 * last.centroid_m).norm() < 0.8 * max_cut * step);
      last = now;
    }
    RC_ASSERT(std::abs(last.volume_m3 - shape({normal, 10}).volume_m3) < 1e-9);
  }
}

}  // namespace
}  // namespace sim
