// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/camera/optics.hpp"

namespace sim {
class World;
}

namespace viewer {

/// Camera pose for an overview image of a world.
struct Overview {
  sim::Pose X_WS = sim::Pose::Identity();  ///< of a camera, which looks along x of S
  std::vector<std::string> hidden;         ///< vehicles that are occluded from this pose
  std::vector<std::string> tiny;           ///< vehicles less than a few pixels wide
};

/// Returns the pose of an upright camera at `eye_W` that looks at `look_W`; straight up or down, north is up in the
/// image.
sim::Pose look_at(const sim::Vector3d& eye_W, const sim::Vector3d& look_W);

/// Finds a pose from which all vehicles with all their parts are inside the image, with some of their surroundings:
/// from the south-west and above where they are visible from there, else from the direction and height from which most
/// of them are. In a world without vehicles, and with `everything`, all objects except planes are included.
Overview overview_of(const sim::World& world, const sim::OpticsConfig& optics, bool everything = false);

/// Returns the pose from which all vehicles, or one, are inside the image, with some of their surroundings: in the
/// direction `back_W` from them.  In a world without vehicles all objects except planes are.
sim::Pose framing_pose(const sim::World& world, const sim::OpticsConfig& optics, const sim::Vector3d& back_W,
                       const std::string& vehicle = "");

}  // namespace viewer
