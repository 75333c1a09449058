// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "sim/geometry/mesh.hpp"

namespace tools {

struct MeshImportOptions {
  double scale = 1;  ///< factor of all vertices
  /// Up axis of the coordinates in the file, 'y' or 'z': y is then mapped to z, and z to -y.  Unset: the axis of the
  /// format, y in glTF, the axis named in the file in Collada; z in formats that do not define one.
  std::optional<char> up;
  double timeout_s = 60;
};

/// Reads a file of any format that Assimp supports; all its meshes are merged, in the frame of the file's root.  The
/// unit of Collada is applied.  Assimp runs in a child process, because damaged files make it crash or hang.  Throws
/// sim::MeshError.
sim::Mesh import_mesh(const std::string& path, const MeshImportOptions& options);

/// Writes binary STL or OBJ, according to the extension.  Throws sim::MeshError.
void save_mesh(const sim::Mesh& mesh, const std::string& path);

/// Error of the child process; what() is `failed on this file` or `took longer than 60 s`.
class ChildError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ChildLimits {
  double time_s = 60;
  std::size_t memory_bytes = std::size_t{4} << 30;  ///< of address space; not with AddressSanitizer, which needs more
};

/// Executes `work` in a child process, where crashes, endless loops and excessive memory are contained, and returns its
/// bytes.  Its output is discarded.  Throws ChildError.
std::string do_in_child(const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace tools
