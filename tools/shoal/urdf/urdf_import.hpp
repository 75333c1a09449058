// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/shoal/urdf/imported_meshes.hpp"

namespace tools {

/// Files and notes of an import.
struct RobotImport {
  ImportedVehicle vehicle;
  std::string text;              ///< of the vehicle file
  std::vector<MeshFile> meshes;  ///< to be written beside it
};

struct RobotImportOptions {
  Base base = Base::free;
  std::optional<double> density_kgpm3;  ///< of bodies without mass; unset: they are refused
  MeshOptions meshes;
  std::string schema;  ///< path of vehicle.schema.json; empty: none
};

/// Reads a URDF and converts it into a vehicle file.  Throws sim::ConfigError of one line.
RobotImport import_urdf(const std::string& path, const RobotImportOptions& options);

}  // namespace tools
