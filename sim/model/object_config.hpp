// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/model/mechanism_config.hpp"
#include "sim/model/placement.hpp"

namespace sim {

/// Object: bodies without devices.
struct ObjectConfig : MechanismConfig {
  std::string name;
  Vector3d position_m = Vector3d::Zero();
  Vector3d rpy_rad = Vector3d::Zero();
  bool fixed = false;   ///< static
  bool present = true;  ///< false: absent until an event adds it
  int count = 1;
  PlacementConfig placement;
  std::shared_ptr<const ConfigNode> source;  ///< YAML node it was read from; null: created in code
  SourcePlace place;

  ObjectConfig();
  ObjectConfig(const ObjectConfig&);
  ObjectConfig(ObjectConfig&&) noexcept;
  ObjectConfig& operator=(const ObjectConfig&);
  ObjectConfig& operator=(ObjectConfig&&) noexcept;
  ~ObjectConfig();

  void read(ParamReader& in);
  /// Returns whether an actor moves its first body, which is then kinematic.
  bool led() const { return bodies.front().kinematic; }
  /// Returns why an actor cannot move it; empty: one can.
  std::string error_of_leading() const;

 private:
  void check_keys(ParamReader& in) const;
};

/// Reports an error when `name` is a reserved word (any, world, sim).
void refuse_reserved(ParamReader& in, const std::string& name);

}  // namespace sim
