// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/config_node.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tools/shoal/sdf/sdf_import.hpp"

// Models in SDF, as `shoal import sdf --meshes none` reads them, and the vehicle file that it writes.

SHOAL_FUZZ_TARGET(sdf) {
  fuzz::Reader reader(input);
  tools::RobotImportOptions options;
  options.meshes.use = tools::MeshUse::none;
  if (reader.below(2) == 1) options.base = tools::Base::fixed;
  if (reader.below(2) == 1) options.density_kgpm3 = 1000;
  fuzz::allow<sim::ConfigError>([&] {
    tools::SdfFiles files("m.sdf", {});
    files.add("m.sdf", std::string(fuzz::text_of(reader.rest())));
    const tools::RobotImport import = tools::import_sdf(files, "m.sdf", "", options);
    fuzz::require(!import.vehicle.bodies.empty(), "a model has a body");
    for (const tools::ImportedBody& body : import.vehicle.bodies)
      fuzz::require(body.mass_kg > 0 && body.inertia_kgm2.allFinite() && body.X_VB.matrix().allFinite(),
                    "masses and poses are numbers");
    for (const tools::ImportedDevice& device : import.vehicle.devices)
      fuzz::require(device.X_BS.matrix().allFinite(), "poses of devices are numbers");
    sim::Diagnostics diagnostics;
    const sim::ConfigNode read = sim::parse_config_text(import.text, "m.yaml", diagnostics);
    fuzz::require(diagnostics.ok(), "the vehicle file is YAML");
    const sim::ConfigNode* bodies = read.find("bodies");
    fuzz::require(bodies != nullptr && bodies->items.size() == import.vehicle.bodies.size(), "the file has all bodies");
  });
}
