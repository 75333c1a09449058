// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/world_difference.hpp"

#include <algorithm>
#include <set>

namespace experiment {

namespace {

std::vector<std::string> entities_in(const sim::WorldConfig& world) {
  std::vector<std::string> entities;
  const auto add = [&](const std::string& kind, const std::string& name) {
    if (!name.empty()) entities.push_back(kind + " '" + name + "'");
  };
  for (const sim::ObjectConfig& object : world.objects) add("object", object.name);
  for (const sim::VehicleInstance& vehicle : world.vehicles) {
    add("vehicle", vehicle.name);
    for (const sim::DeviceConfig& device : vehicle.config->devices) add("device", vehicle.name + "/" + device.name);
  }
  for (const sim::EventConfig& event : world.events) add("event", event.name);
  return entities;
}

}  // namespace

std::vector<std::string> entities_only_in(const sim::WorldConfig& world, const sim::WorldConfig& other) {
  const std::vector<std::string> others = entities_in(other);
  const std::set<std::string> known(others.begin(), others.end());
  std::vector<std::string> entities = entities_in(world);
  std::erase_if(entities, [&](const std::string& entity) { return known.contains(entity); });
  return entities;
}

}  // namespace experiment
