// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/sdf/sdf_import.hpp"

#include "tools/shoal/sdf/sdf_plugins.hpp"
#include "tools/shoal/sdf/sdf_reader.hpp"

namespace tools {

RobotImport import_sdf(const std::string& path, const std::string& model, const RobotImportOptions& options) {
  SdfFiles files(path, options.meshes.folders);
  return import_sdf(files, path, model, options);
}

RobotImport import_sdf(SdfFiles& files, const std::string& path, const std::string& model_name,
                       const RobotImportOptions& options) {
  SdfModel model = read_sdf(files, path, model_name);
  prepare_joints(model);
  // Coefficients refer to the frame of their link, which so becomes that of its body.
  std::string root;
  for (const SdfPlugin& plugin : model.plugins)
    if (root.empty()) root = link_of_water(plugin);
  if (root.empty() && !model.added_masses.empty()) root = model.added_masses.front().link;
  if (!root.empty() && !model.frames.has(root)) root.clear();
  const Base base = model.is_static ? Base::fixed : options.base;
  const NoMass no_mass = options.density_kgpm3 ? NoMass::of_shapes : NoMass::refused;
  RobotImport result;
  result.vehicle = vehicle_of(robot_of(model, root, no_mass), path, base, no_mass);
  result.vehicle.format = "sdf";
  finish_import(result, options, [&](const std::vector<MeshFile>& meshes) {
    add_water(model, meshes, result.vehicle);
    SdfDevices devices(result.vehicle);
    add_plugins(model, devices);
    add_sensors(model, devices);
  });
  return result;
}

}  // namespace tools
