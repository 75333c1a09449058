#include "sim/world/bottom_check.hpp"

#include <algorithm>

#include "sim/world/mounted_device.hpp"
#include "sim/world/vehicle.hpp"
#include "sim/world/vehicle_config.hpp"
#include "sim/world/world.hpp"

namespace sim {

namespace {

constexpr double deepest_m = 12000;  // deeper than any sea

bool has_coefficients(const BodyConfig& body) {
  return body.hydrodynamics && body.hydrodynamics->model != "none";
}

bool in_water(const World& world, const Vehicle& vehicle, const VehicleConfig& config) {
  return std::any_of(config.bodies.begin(), config.bodies.end(), [&](const BodyConfig& body) {
    return has_coefficients(body) || world.medium().in_water(vehicle.body(body.name).X_WB().translation());
  });
}

bool looks_for_bottom(const Vehicle& vehicle) {
  return std::any_of(vehicle.devices().begin(), vehicle.devices().end(), [](const MountedDevice* device) {
    return device->casts_rays() || (device->senses() && device->sensor()->needs_bottom());
  });
}

}  // namespace

std::vector<std::string> bottom_warnings(const World& world) {
  if (!world.medium().has_water()) return {};
  std::string first;
  int more = -1;
  for (const auto& vehicle : world.vehicles()) {
    if (!looks_for_bottom(*vehicle) || !in_water(world, *vehicle, vehicle->config())) continue;
    RayFilter others;
    others.exclude_group = vehicle->group();
    const Vector3d p_W = vehicle->X_WV().translation();
    if (world.scene().cast(p_W, -Vector3d::UnitZ(), deepest_m, others)) continue;
    if (++more == 0) first = vehicle->name();
  }
  if (more < 0) return {};
  const std::string others = more == 0 ? "" : " (nor below " + std::to_string(more) + " more)";
  return {"there is no bottom below vehicle '" + first + "'" + others + ": what looks down from there sees nothing"};
}

}  // namespace sim
