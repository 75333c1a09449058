// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/camera/optics.hpp"

namespace sim {
class World;
}

namespace tools {

/// An overview image of a world.
struct Overview {
  sim::Pose X_WS = sim::Pose::Identity();  ///< of a camera, which looks along x of S
  std::vector<std::string> hidden;         ///< vehicles behind something, from here
  std::vector<std::string> tiny;           ///< vehicles less than a few pixels wide
};

/// Looks from `eye_W` to `look_W`, upright; straight up or down, north is up in the image.
sim::Pose look_at(const sim::Vector3d& eye_W, const sim::Vector3d& look_W);

/// All vehicles with all their parts inside the image, and some of what is around them.  From the south-west and above
/// where they can be seen from there, else from the direction and height from which the most of them can.  In a world
/// without vehicles, and with `everything`: all objects too, apart from planes.
Overview overview_of(const sim::World& world, const sim::OpticsConfig& optics, bool everything = false);

}  // namespace tools
