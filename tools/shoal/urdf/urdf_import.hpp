// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
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
  RobotMeshOptions meshes;
  std::string schema;  ///< path of vehicle.schema.json; empty: none
};

/// Reads a URDF and converts it into a vehicle file.  Throws sim::ConfigError of one line.
RobotImport import_urdf(const std::string& path, const RobotImportOptions& options);

/// Completes the import of a vehicle: its meshes, the masses that it lacks, what `add_devices` adds, and the text.
void finish_import(RobotImport& result, const RobotImportOptions& options,
                   const std::function<void(const std::vector<MeshFile>& meshes)>& add_devices);

}  // namespace tools
