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

/// Error of a file that is not a usable triangle mesh.  what() gives the reason without the name of the file.
class MeshError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Maximum number of triangles of a mesh, which limits memory use in ODE and in ray casting.
constexpr std::size_t max_mesh_triangles = 4'000'000;

/// Triangle mesh.
struct Mesh {
  std::vector<Vector3d> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
};

/// Volume, centroid and inertia (about the centroid) of the solid enclosed by a mesh, for density 1.
struct MeshSolid {
  double volume_m3 = 0;
  Vector3d centroid_m = Vector3d::Zero();
  Matrix3d inertia = Matrix3d::Zero();
};

/// Reads STL (binary or ASCII) or OBJ, selected by the extension of the file.  Vertices are multiplied by `scale`.
/// Triangles with two equal corners are dropped; other degenerate triangles are kept, because dropping them could open
/// the surface.  Throws MeshError when the file is missing, too large, truncated or of another format, has numbers that
/// are not finite, or has no triangle with an area.
Mesh load_mesh(const std::string& path, double scale);
/// Parses the contents of an STL file.  Words may be in capitals; a byte order mark, blank lines before `solid`, lines
/// that end with a carriage return, and bytes after the last triangle of a binary file do no harm.  Throws MeshError.
Mesh parse_stl(std::string_view bytes);
/// Parses the contents of an OBJ file: vertices and faces, with positive numbers in any order and negative ones.  All
/// else is ignored, also normals, textures and materials.  Throws MeshError.
Mesh parse_obj(std::string_view text);

/// Returns true when the mesh encloses a solid: every edge is shared by two triangles with opposite directions.
bool is_closed(const Mesh& mesh);
/// Returns the mass properties of a closed mesh.  The volume is negative when the triangles face inwards.
MeshSolid solid_of(const Mesh& mesh);
/// Reverses the orientation of every triangle.
void turn_inside_out(Mesh& mesh);

}  // namespace sim
