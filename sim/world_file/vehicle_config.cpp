// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/vehicle_config.hpp"

#include "sim/config/common_keys.hpp"

namespace sim {

VehicleConfig::VehicleConfig() = default;
VehicleConfig::VehicleConfig(const VehicleConfig&) = default;
VehicleConfig::VehicleConfig(VehicleConfig&&) noexcept = default;
VehicleConfig& VehicleConfig::operator=(const VehicleConfig&) = default;
VehicleConfig& VehicleConfig::operator=(VehicleConfig&&) noexcept = default;
VehicleConfig::~VehicleConfig() = default;

void VehicleConfig::read(ParamReader& in) {
  // Identification and parameters.
  read_version(in, "shoal", shoal);
  in.read("vehicle", vehicle, "name of this kind of vehicle");
  in.read("description", description, "description in one sentence");
  in.read_raw("parameters", parameters, "default of each ${name} used in the file");
  // Surfaces.
  in.read_list("materials", materials, "material", "materials that this vehicle adds to the world");
  for (const MaterialConfig& material : materials) in.declare("material", material.name);
  in.read_list("contacts", contacts, "contact", "contact parameters of pairs of materials");
  in.read("categories", categories, "categories of parts that this vehicle adds to the world");
  for (const std::string& category : categories) in.declare("category", category);
  // Properties of the whole vehicle.
  in.read("actuator_latency_s", actuator_latency_s, between(0, 1e6),
          "from command to effect, added to the latency of each actuator");
  in.read("clock", clock, "clock with which its devices stamp their reports; unset: true time");
  // Bodies, joints and devices.
  in.require("bodies");
  read_mechanism(in);
  in.read_list("devices", devices, "device", "sensors and actuators; keys by type, see docs/reference/devices.md");
  for (const DeviceConfig& device : devices) in.declare("device", device.name);
}

}  // namespace sim
