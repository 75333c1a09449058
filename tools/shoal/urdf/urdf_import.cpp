// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_import.hpp"

#include <algorithm>

#include "tools/shoal/urdf/urdf_reader.hpp"
#include "tools/shoal/urdf/vehicle_text.hpp"

namespace tools {

UrdfImport import_urdf(const std::string& path, Base base, const UrdfMeshOptions& meshes, const std::string& schema) {
  UrdfImport result;
  result.vehicle = vehicle_of(read_urdf_file(path), path, base);
  result.meshes = convert_meshes(result.vehicle, meshes);
  std::stable_sort(result.vehicle.notes.begin(), result.vehicle.notes.end(),
                   [](const UrdfNote& a, const UrdfNote& b) { return a.place.line < b.place.line; });
  result.text = vehicle_text(result.vehicle, schema);
  return result;
}

}  // namespace tools
