// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/check_script.hpp"

#include "sim/config/message_text.hpp"

namespace sim {

namespace {

void check_actor(const ActorConfig& actor, WorldConfig& world, Diagnostics& diagnostics) {
  const std::string who = "actor '" + actor.name + "'";
  for (ObjectConfig& object : world.objects) {
    if (object.name != actor.object) continue;
    if (object.count != 1) diagnostics.error(actor.place, who, "'object' must be one object, not a 'count' of them");
    if (const std::string error = object.error_of_leading(); !error.empty())
      diagnostics.error(actor.place, who, "object '" + object.name + "' " + error);
    if (object.led())
      diagnostics.error(actor.place, who, "object '" + object.name + "' is already moved by another actor");
    object.bodies.front().kinematic = true;
  }
}

}  // namespace

void ActionCheck::error(const std::string& text) const {
  diagnostics_.error(entry_.place, entry_.who, text);
}

NamedDevice ActionCheck::device(const std::string& name) const {
  const NamedDevice found = find_device_(name);
  if (found.device != nullptr && found.device->device_type != nullptr) return found;
  error("there is no device '" + shortened(printable(name)) + "'; devices are named VEHICLE/DEVICE" +
        devices_of(name.substr(0, name.find('/'))));
  return {};
}

/// Returns `; vehicle 'r1' has: gps, imu`; empty when there is no such vehicle.
std::string ActionCheck::devices_of(const std::string& vehicle) const {
  for (const VehicleInstance& instance : world_.vehicles) {
    if (instance.name != vehicle || !instance.config) continue;
    std::vector<std::string> names;
    for (const DeviceConfig& device : instance.config->devices) names.push_back(device.name);
    return "; vehicle '" + vehicle + "' has: " + list_text(names);
  }
  return {};
}

void ActionCheck::check(const std::vector<ActionEntry>& actions) const {
  check_actions(actions, world_, find_device_, diagnostics_);
}

void check_actions(const std::vector<ActionEntry>& actions, const WorldConfig& world, const FindDevice& find_device,
                   Diagnostics& diagnostics) {
  for (const ActionEntry& entry : actions)
    if (entry.action) entry.action->check({world, find_device, diagnostics, entry});
}

void check_script(WorldConfig& world, Diagnostics& diagnostics) {
  for (const ActorConfig& actor : world.actors) check_actor(actor, world, diagnostics);
  const FindDevice find = [&](const std::string& name) { return device_of(world, name); };
  for (const EventConfig& event : world.events) {
    if (event.every_s > 0 && event.every_s < world.physics.step_s)
      diagnostics.error(event.place, "event '" + event.name + "'",
                        "'every' must be at least a step of " + number_text(world.physics.step_s) + " s");
    check_actions(event.actions, world, find, diagnostics);
  }
}

}  // namespace sim
