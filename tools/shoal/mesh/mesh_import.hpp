// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "sim/geometry/mesh.hpp"

namespace tools {

struct MeshImportOptions {
  double scale = 1;  ///< vertices are multiplied by it
  /// Axis of the file's numbers that points up, 'y' or 'z': y becomes z then, and z becomes -y.  Unset: what the format
  /// says, y in glTF, the axis that the file names in Collada; z in others, which say nothing.
  std::optional<char> up;
  double timeout_s = 60;
};

/// Reads a file of any format that Assimp knows; all its meshes become one, in the frame of the file's root.  Collada's
/// unit is applied.  Assimp works in a child process, since damaged files make it crash or hang.  Throws
/// sim::MeshError.
sim::Mesh import_mesh(const std::string& path, const MeshImportOptions& options);

/// Writes binary STL or OBJ, whichever the name ends in.  Throws sim::MeshError.
void save_mesh(const sim::Mesh& mesh, const std::string& path);

}  // namespace tools
