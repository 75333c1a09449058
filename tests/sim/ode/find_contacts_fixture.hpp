// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sim/ode/find_contacts.hpp"
#include "sim/ode/ode_library.hpp"
#include "sim/ode/part_shape.hpp"

namespace find_contacts_fixture {

/// Square of 2 m of two triangles in the plane z = 0.
inline sim::Mesh square_mesh() {
  sim::Mesh mesh;
  mesh.vertices_m = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Returns the sum of the depths of a sphere that is pressed into the square in ever other places.
inline double sum_of_depths(int count) {
  sim::start_ode();
  const sim::Mesh mesh = square_mesh();
  const sim::TriMeshDataHandle data = sim::make_trimesh_data(mesh);
  const sim::GeomHandle square(dCreateTriMesh(nullptr, data.get(), nullptr, nullptr, nullptr));
  const sim::GeomHandle sphere(dCreateSphere(nullptr, 0.5));
  std::array<dContactGeom, 8> contacts;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    dGeomSetPosition(sphere.get(), 0.4, -0.001 * (i % 100), 0.45);
    const int found = sim::find_contacts(square.get(), sphere.get(), static_cast<int>(contacts.size()), contacts.data(),
                                         sizeof contacts[0]);
    for (int k = 0; k < found; ++k) sum += contacts[static_cast<std::size_t>(k)].depth;
  }
  return sum;
}

}  // namespace find_contacts_fixture
