// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/config_node.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tools/shoal/urdf/imported_meshes.hpp"
#include "tools/shoal/urdf/mass_of_shapes.hpp"
#include "tools/shoal/urdf/urdf_reader.hpp"
#include "tools/shoal/urdf/vehicle_text.hpp"

// Robots in URDF, as `shoal import urdf --meshes none` reads them, and the vehicle file that it writes.

SHOAL_FUZZ_TARGET(urdf) {
  fuzz::Reader reader(input);
  const tools::Base base = reader.below(2) == 0 ? tools::Base::free : tools::Base::fixed;
  fuzz::allow<sim::ConfigError>([&] {
    const tools::NoMass no_mass = reader.below(2) == 0 ? tools::NoMass::refused : tools::NoMass::of_shapes;
    const std::string urdf(fuzz::text_of(reader.rest()));
    tools::ImportedVehicle vehicle = tools::vehicle_of(tools::read_urdf(urdf, "r.urdf"), "r.urdf", base, no_mass);
    tools::complete_masses(vehicle, tools::convert_meshes(vehicle, {.use = tools::MeshUse::none}));
    fuzz::require(!vehicle.bodies.empty(), "a robot has a body");
    for (const tools::ImportedBody& body : vehicle.bodies)
      fuzz::require(body.mass_kg > 0 && body.inertia_kgm2.allFinite() && body.X_VB.matrix().allFinite(),
                    "masses and poses are numbers");
    sim::Diagnostics diagnostics;
    const sim::ConfigNode read = sim::parse_config_text(tools::vehicle_text(vehicle, ""), "r.yaml", diagnostics);
    fuzz::require(diagnostics.ok(), "the vehicle file is YAML");
    const sim::ConfigNode* bodies = read.find("bodies");
    fuzz::require(bodies != nullptr && bodies->items.size() == vehicle.bodies.size(), "the file has all bodies");
  });
}
