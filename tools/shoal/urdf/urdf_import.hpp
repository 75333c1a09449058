// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/shoal/urdf/imported_meshes.hpp"

namespace tools {

/// Files and notes of an import.
struct UrdfImport {
  ImportedVehicle vehicle;
  std::string text;              ///< of the vehicle file
  std::vector<MeshFile> meshes;  ///< to be written beside it
};

/// Reads a URDF and converts it into a vehicle file.  `schema`: path of vehicle.schema.json; empty: none.  Throws
/// sim::ConfigError of one line.
UrdfImport import_urdf(const std::string& path, Base base, const UrdfMeshOptions& meshes, const std::string& schema);

}  // namespace tools
