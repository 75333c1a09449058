// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/shoal/sdf/sdf_devices.hpp"

namespace tools {

/// Kinds of plugins that become part of a vehicle.
enum class SdfPluginKind {
  hydrodynamics,
  simple_hydrodynamics,
  uuv_hydrodynamics,
  thruster,
  fin,
  wheels,
  buoyancy_engine
};

/// Kind of a plugin by its name or its library; nothing for others.
std::optional<SdfPluginKind> kind_of_plugin(const XmlElement& plugin);

/// Link whose coefficients the plugin gives; empty: it is of another kind.
std::string link_of_water(const SdfPlugin& plugin);

/// Prepares the joints of the model that plugins drive: the propeller of a thruster and a fin become parts of what
/// carries them, and wheels get no servo.  Adds a note for each plugin that is not imported.
void prepare_joints(SdfModel& model);

/// Adds the devices of plugins.
void add_plugins(SdfModel& model, SdfDevices& devices);

/// Adds the coefficients of plugins and `<fluid_added_mass>` to the bodies, and the volume of their collisions.
void add_water(const SdfModel& model, const std::vector<MeshFile>& meshes, ImportedVehicle& vehicle);

}  // namespace tools
