// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "sim/world_file/device_change.hpp"

namespace sim {

using FindDevice = std::function<NamedDevice(const std::string&)>;

/// What an action sees when it is checked.
class ActionCheck {
 public:
  /// `find_device`: by VEHICLE/DEVICE.  All must outlive this.
  ActionCheck(const WorldConfig& world, const FindDevice& find_device, Diagnostics& diagnostics,
              const ActionEntry& entry)
      : world_(world), find_device_(find_device), diagnostics_(diagnostics), entry_(entry) {}

  const WorldConfig& world() const { return world_; }
  const ActionEntry& entry() const { return entry_; }
  Diagnostics& diagnostics() const { return diagnostics_; }
  void error(const std::string& text) const;
  /// The device VEHICLE/DEVICE.  Reports when there is none, and gives an empty one.
  NamedDevice device(const std::string& name) const;
  /// For an action that holds others.
  void check(const std::vector<ActionEntry>& actions) const;

 private:
  std::string devices_of(const std::string& vehicle) const;

  const WorldConfig& world_;
  const FindDevice& find_device_;
  Diagnostics& diagnostics_;
  const ActionEntry& entry_;
};

/// What is checked once the vehicles of a world are known: objects of actors, and actions (devices, faults, changes of
/// values, messages, which are encoded now).
void check_script(WorldConfig& world, Diagnostics& diagnostics);

/// The same for actions.
void check_actions(const std::vector<ActionEntry>& actions, const WorldConfig& world, const FindDevice& find_device,
                   Diagnostics& diagnostics);

}  // namespace sim
