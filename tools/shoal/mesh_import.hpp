#pragma once

#include <string>

#include "sim/physics/mesh.hpp"

namespace tools {

/// Reads a file of any format that Assimp knows; all its meshes become one, in the frame of the file's root.  Vertices
/// are multiplied by `scale`.  `y_up`: y of the file becomes z, and z becomes -y.  Throws sim::MeshError.
sim::Mesh import_mesh(const std::string& path, double scale, bool y_up);

/// Writes binary STL or OBJ, whichever the name ends in.  Throws sim::MeshError.
void save_mesh(const sim::Mesh& mesh, const std::string& path);

}  // namespace tools
