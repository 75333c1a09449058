// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_import.hpp"

#include <algorithm>

#include "tools/shoal/urdf/mass_of_shapes.hpp"
#include "tools/shoal/urdf/urdf_reader.hpp"
#include "tools/shoal/urdf/vehicle_text.hpp"

namespace tools {

RobotImport import_urdf(const std::string& path, const RobotImportOptions& options) {
  RobotImport result;
  result.vehicle =
      vehicle_of(read_urdf_file(path), path, options.base, options.density_kgpm3 ? NoMass::of_shapes : NoMass::refused);
  finish_import(result, options, {});
  return result;
}

void finish_import(RobotImport& result, const RobotImportOptions& options,
                   const std::function<void(const std::vector<MeshFile>& meshes)>& add_devices) {
  result.meshes = convert_meshes(result.vehicle, options.meshes);
  complete_masses(result.vehicle, result.meshes, options.density_kgpm3.value_or(usual_density_kgpm3));
  if (add_devices) add_devices(result.meshes);
  const auto before = [](const ImportNote& a, const ImportNote& b) {
    return a.place.file == b.place.file ? a.place.line < b.place.line : *a.place.file < *b.place.file;
  };
  std::stable_sort(result.vehicle.notes.begin(), result.vehicle.notes.end(), before);
  result.text = vehicle_text(result.vehicle, options.schema);
}

}  // namespace tools
