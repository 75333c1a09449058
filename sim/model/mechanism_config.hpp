// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "sim/model/physics_config.hpp"

namespace sim {

/// Bodies of a vehicle or an object, and the joints between them.  The first body carries its frame.
struct MechanismConfig {
  bool self_collision = false;
  std::vector<BodyConfig> bodies;
  std::vector<JointConfig> joints;

  /// Reads the keys `self_collision`, `bodies` and `joints`, and declares the names of bodies, parts and joints.
  void read_mechanism(ParamReader& in);
  /// Declares its bodies and parts, for keys that refer to them.
  void declare_bodies(ParamReader& in) const;

  /// Returns whether a joint holds a body in the world.
  bool anchored() const;
  /// Returns the bodies without a chain of joints to the first one, also by way of the world.
  std::vector<const BodyConfig*> unconnected() const;
  std::size_t part_count() const;
  /// Returns whether a body has hydrodynamic coefficients, as that of a craft.
  bool has_coefficients() const {
    return std::any_of(bodies.begin(), bodies.end(), [](const BodyConfig& body) { return body.has_coefficients(); });
  }
  /// Returns whether a condition holds for a part.
  template <typename Condition>
  bool any_part(Condition condition) const {
    return std::any_of(bodies.begin(), bodies.end(), [&](const BodyConfig& body) {
      return std::any_of(body.parts.begin(), body.parts.end(), condition);
    });
  }
};

}  // namespace sim
