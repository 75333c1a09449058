// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/model/physics_config.hpp"
#include "sim/model/placement.hpp"

namespace sim {

/// A thing without devices.
struct ObjectConfig {
  std::string name;
  Vector3d position_m = Vector3d::Zero();
  Vector3d rpy_rad = Vector3d::Zero();
  bool fixed = false;      ///< never moves
  bool present = true;     ///< false: it is absent until an event adds it
  bool kinematic = false;  ///< an actor moves it
  int count = 1;
  PlacementConfig placement;
  std::vector<PartConfig> parts;
  std::shared_ptr<const ConfigNode> source;  ///< what it was read from; null: made by hand
  SourcePlace place;
  void read(ParamReader& in);
};

/// Refuses, as `name`, words that mean something else where names are used.
void refuse_reserved(ParamReader& in, const std::string& name);

}  // namespace sim
