// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/camera/renderer.hpp"
#include "sim/image/image_file.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace rendered_worlds {

using namespace small_worlds;

/// 200 x 150 pixels, focal length 200 px.
inline sim::OpticsConfig lens() {
  sim::OpticsConfig config;
  config.width = 200, config.height = 150;
  config.focal_px = {200};
  return config;
}

inline sim::Frame render(const PhysicsWorld& world, const Pose& X_WS, const sim::RenderOptions& options,
                         int per_side = 1) {
  sim::Renderer renderer(world, sim::make_pixel_rays(sim::Optics(lens()), per_side), options,
                         std::make_shared<sim::TextureLibrary>());
  sim::Frame frame;
  renderer.render(X_WS, frame);
  return frame;
}

/// A sun that stands in the west, this high, and no sky.
inline sim::RenderOptions sun_in_the_west(double elevation_deg) {
  sim::RenderOptions options;
  options.light.sun_azimuth_rad = sim::degrees_to_radians(270);
  options.light.sun_elevation_rad = sim::degrees_to_radians(elevation_deg);
  options.light.sun = 1;
  options.light.sky = 0;
  return options;
}

inline std::unique_ptr<PhysicsWorld> world_of(const MaterialConfig& material) {
  return std::make_unique<PhysicsWorld>(PhysicsConfig{}, std::vector{material}, std::vector<ContactConfig>{},
                                        std::vector<std::string>{}, 1);
}

/// At a height, looking straight down; the top of the image is north.
inline Pose looking_down(double x, double y, double z) {
  Pose X_WS = translation(x, y, z);
  X_WS.linear() << Vector3d(0, 0, -1), Vector3d(-1, 0, 0), Vector3d(0, 1, 0);
  return X_WS;
}

}  // namespace rendered_worlds
