// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/bottom_check.hpp"

#include <algorithm>

#include "sim/vehicle/mounted_device.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace sim {

namespace {

constexpr double deepest_m = 12000;  // deeper than any ocean

bool in_water(const World& world, const Vehicle& vehicle, const VehicleConfig& config) {
  return std::any_of(config.bodies.begin(), config.bodies.end(), [&](const BodyConfig& body) {
    return body.has_coefficients() || world.medium().in_water(vehicle.body(body.name).X_WB().translation());
  });
}

bool looks_for_bottom(const Vehicle& vehicle) {
  return std::any_of(vehicle.devices().begin(), vehicle.devices().end(), [](const MountedDevice* device) {
    return device->casts_rays() || (device->senses() && device->sensor()->needs_bottom());
  });
}

bool over_nothing(const World& world, const Vehicle& vehicle) {
  if (!looks_for_bottom(vehicle) || !in_water(world, vehicle, vehicle.config())) return false;
  RayFilter others;
  others.exclude_group = vehicle.group();
  return !world.scene().cast(vehicle.X_WV().translation(), -Vector3d::UnitZ(), deepest_m, others);
}

std::vector<std::string> lines_about(const std::vector<const Vehicle*>& over_nothing) {
  if (over_nothing.empty()) return {};
  const std::size_t more = over_nothing.size() - 1;
  const std::string others = more == 0 ? "" : " (nor below " + std::to_string(more) + " more)";
  return {"there is no bottom below vehicle '" + over_nothing[0]->name() + "'" + others +
          ": downward-looking sensors there detect nothing"};
}

}  // namespace

std::vector<std::string> bottom_warnings(const World& world) {
  std::vector<const Vehicle*> found;
  if (world.medium().has_water())
    for (const auto& vehicle : world.vehicles())
      if (over_nothing(world, *vehicle)) found.push_back(vehicle.get());
  return lines_about(found);
}

std::vector<std::string> bottom_warnings(const World& world, const Vehicle& vehicle) {
  if (!world.medium().has_water() || !over_nothing(world, vehicle)) return {};
  return lines_about({&vehicle});
}

}  // namespace sim
