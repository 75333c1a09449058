// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/geometry/mesh.hpp"
#include "tools/shoal/urdf/imported_vehicle.hpp"
#include "tools/shoal/urdf/robot_folders.hpp"

namespace tools {

/// Treatment of the meshes of a robot.
enum class MeshUse {
  hull,  ///< collisions: the convex hull; visual shapes: the mesh itself
  box,   ///< the bounding box
  none   ///< left out
};

struct RobotMeshOptions {
  MeshUse use = MeshUse::hull;
  std::string folder = "meshes";  ///< of the files to write, below that of the vehicle file
  FolderOptions folders;
};

/// Mesh file to write: path relative to the folder of the vehicle file, and its mesh.
using MeshFile = std::pair<std::string, sim::Mesh>;

/// Replaces the meshes of the vehicle's parts: by boxes, by nothing, or by mesh files, which it returns.
/// A mesh must lie in one of the folders.  Throws sim::ConfigError.
std::vector<MeshFile> convert_meshes(ImportedVehicle& vehicle, const RobotMeshOptions& options);

}  // namespace tools
