// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/math.hpp"

namespace sim {

/// A file that is not a usable triangle mesh; what() says why, without the file's name.
class MeshError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// More than ODE and a scene of rays can be expected to take.
constexpr std::size_t max_mesh_triangles = 4'000'000;

struct Mesh {
  std::vector<Vector3d> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
};

/// Volume, centroid and inertia (about the centroid) of the solid that the mesh encloses, for density 1.
struct MeshSolid {
  double volume_m3 = 0;
  Vector3d centroid_m = Vector3d::Zero();
  Matrix3d inertia = Matrix3d::Zero();
};

/// Reads STL (binary or ASCII) or OBJ, whichever the name ends in.  Vertices are multiplied by `scale`.  Triangles with
/// two equal corners are left out; others without area stay, for leaving them out could open a surface.  Throws
/// MeshError: no file, too large, cut off, not this format, numbers that are not finite, no triangle with an area.
Mesh load_mesh(const std::string& path, double scale);
/// The same from the bytes of a file.
Mesh parse_stl(std::string_view bytes);
Mesh parse_obj(std::string_view text);

/// Every edge is shared by two triangles that run along it in opposite directions: the mesh encloses a solid.
bool is_closed(const Mesh& mesh);
/// Of a closed mesh.  The volume is negative when the triangles face inwards.
MeshSolid solid_of(const Mesh& mesh);
/// Turns every triangle over.
void turn_inside_out(Mesh& mesh);

}  // namespace sim
