// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/model/physics_config.hpp"
#include "sim/model/placement.hpp"

namespace sim {

/// Object: one or more parts without devices.
struct ObjectConfig {
  std::string name;
  Vector3d position_m = Vector3d::Zero();
  Vector3d rpy_rad = Vector3d::Zero();
  bool fixed = false;      ///< static
  bool present = true;     ///< false: absent until an event adds it
  bool kinematic = false;  ///< moved by an actor, not by forces
  int count = 1;
  PlacementConfig placement;
  std::vector<PartConfig> parts;
  std::shared_ptr<const ConfigNode> source;  ///< YAML node it was read from; null: created in code
  SourcePlace place;

  ObjectConfig();
  ObjectConfig(const ObjectConfig&);
  ObjectConfig(ObjectConfig&&) noexcept;
  ObjectConfig& operator=(const ObjectConfig&);
  ObjectConfig& operator=(ObjectConfig&&) noexcept;
  ~ObjectConfig();

  void read(ParamReader& in);
};

/// Reports an error when `name` is a reserved word (any, world, sim).
void refuse_reserved(ParamReader& in, const std::string& name);

}  // namespace sim
