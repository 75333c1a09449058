// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/check_script.hpp"

#include <algorithm>
#include <map>

#include "sim/bus/utime_stamp.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"

namespace sim {

namespace {

using FindDevice = std::function<NamedDevice(const std::string&)>;

class ActionCheck {
 public:
  ActionCheck(const WorldConfig& world, const FindDevice& find_device, Diagnostics& diagnostics)
      : world_(world), find_device_(find_device), diagnostics_(diagnostics) {}

  void check(Action& action) {
    for (std::vector<Action>& choice : action.choices)
      for (Action& each : choice) check(each);
    if (action.kind == ActionKind::fault || action.kind == ActionKind::clear_fault || action.kind == ActionKind::set)
      check_device(action);
    if (action.kind == ActionKind::publish) encode(action);
    if (action.kind == ActionKind::gravity && world_.medium.water)
      error(action,
            "'gravity_mps2' cannot change in a world with water: pressure, waves and published weights are for " +
                number_text(world_.physics.gravity_mps2) + " m/s^2, which the world begins with");
  }

 private:
  void check_device(const Action& action) {
    const std::string& name = action.targets[0];
    const NamedDevice found = find_device_(name);
    if (found.device == nullptr || found.device->device_type == nullptr)
      return error(action, "there is no device '" + shortened(printable(name)) + "'; devices are named VEHICLE/DEVICE" +
                               devices_of(name.substr(0, name.find('/'))));
    if (action.kind == ActionKind::set) {
      changed_device(*found.device, *found.vehicle, world_, action.values, action.who, diagnostics_);
      return;
    }
    if (action.kind == ActionKind::clear_fault) return;
    const std::string misfit = fault_misfit(*found.device->device_type, action.fault);
    if (!misfit.empty()) error(action, "device '" + name + "': " + misfit);
  }

  /// `; vehicle 'r1' has: gps, imu`; nothing when there is no such vehicle.
  std::string devices_of(const std::string& vehicle) const {
    for (const VehicleInstance& instance : world_.vehicles) {
      if (instance.name != vehicle || !instance.config) continue;
      std::vector<std::string> names;
      for (const DeviceConfig& device : instance.config->devices) names.push_back(device.name);
      return "; vehicle '" + vehicle + "' has: " + list_text(names);
    }
    return {};
  }

  void encode(Action& action) {
    if (!world_.encode_message) return error(action, "messages cannot be encoded here");
    Diagnostics found;
    action.payload = world_.encode_message(action.message_type, action.values, found);
    for (const std::string& line : found.lines()) diagnostics_.error({}, "", line);
    if (!found.ok() || action.values.find("utime") != nullptr) return;
    action.stamp_utime = begins_with_utime(action);
  }

  /// sim/ knows no message types, but one whose first member is `int64_t utime` shows when it is given another one.
  bool begins_with_utime(const Action& action) const {
    ConfigNode stamped = action.values;
    stamped.entries.push_back({"utime", action.place, scalar_node("1", action.place)});
    Diagnostics ignored;
    const Bytes with = world_.encode_message(action.message_type, stamped, ignored);
    if (!ignored.ok() || !utime_of(action.payload)) return false;
    Bytes expected = action.payload;
    set_utime(expected, 1);
    return with == expected;
  }

  void error(const Action& action, const std::string& text) { diagnostics_.error(action.place, action.who, text); }

  const WorldConfig& world_;
  const FindDevice& find_device_;
  Diagnostics& diagnostics_;
};

void check_actor(const ActorConfig& actor, WorldConfig& world, Diagnostics& diagnostics) {
  const std::string who = "actor '" + actor.name + "'";
  for (ObjectConfig& object : world.objects) {
    if (object.name != actor.object) continue;
    if (object.count != 1) diagnostics.error(actor.place, who, "'object' must be one object, not a 'count' of them");
    if (object.fixed) diagnostics.error(actor.place, who, "object '" + object.name + "' is fixed and cannot be moved");
    if (object.kinematic)
      diagnostics.error(actor.place, who, "object '" + object.name + "' is moved by another actor already");
    object.kinematic = true;
  }
}

}  // namespace

void check_actions(std::vector<Action>& actions, const WorldConfig& world, const FindDevice& find_device,
                   Diagnostics& diagnostics) {
  ActionCheck check(world, find_device, diagnostics);
  for (Action& action : actions) check.check(action);
}

void check_script(WorldConfig& world, Diagnostics& diagnostics) {
  for (const ActorConfig& actor : world.actors) check_actor(actor, world, diagnostics);
  const FindDevice find = [&](const std::string& name) { return device_of(world, name); };
  for (EventConfig& event : world.events) {
    if (event.every_s > 0 && event.every_s < world.physics.step_s)
      diagnostics.error(event.place, "event '" + event.name + "'",
                        "'every' must be at least a step of " + number_text(world.physics.step_s) + " s");
    check_actions(event.actions, world, find, diagnostics);
  }
}

}  // namespace sim
