// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/shoal/urdf/imported_vehicle.hpp"

namespace tools {

/// Puts a body together from links that fixed joints connect.
class BodyAssembly {
 public:
  BodyAssembly(std::string name, const sim::Pose& X_VB, const sim::SourcePlace& place);

  const std::string& name() const { return body_.name; }
  const sim::Pose& X_VB() const { return body_.X_VB; }
  /// Adds mass and shapes of a link at X_VL.  A link with collision shapes gives these; another one gives its visual
  /// shapes, which collide with nothing.
  void add(const RobotLink& link, const sim::Pose& X_VL, std::vector<ImportNote>& notes);
  bool has_mass() const;
  bool is_empty() const { return !has_mass() && body_.parts.empty(); }
  const sim::SourcePlace& place() const { return body_.place; }
  /// Gives a body without mass one that matters to nothing, because the body will be fixed to the world.
  void allow_no_mass();
  /// Returns the body.  Throws sim::ConfigError when it has no mass and `no_mass` refuses that, or an impossible
  /// inertia.
  ImportedBody finish(NoMass no_mass, std::vector<ImportNote>& notes);

 private:
  ImportedBody body_;
  sim::Vector3d moment_kgm_ = sim::Vector3d::Zero();    ///< sum of mass times position in B
  sim::Matrix3d about_origin_ = sim::Matrix3d::Zero();  ///< inertia about the origin of B
};

}  // namespace tools
