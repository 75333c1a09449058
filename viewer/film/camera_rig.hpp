// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "sim/world/world.hpp"
#include "viewer/film/scene_painter.hpp"

namespace viewer {

/// Camera that cannot be used with a world.  what() says why, and what there is.
class CameraError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Camera of a film.  It moves by simulated time and by the time of the film, never by a clock.
class CameraRig {
 public:
  virtual ~CameraRig() = default;
  /// Returns the pose and the lens for the present state of the world.  `film_step_s`: time of the film since the last
  /// call; 0 in the first one.
  virtual SceneView view(double film_step_s) = 0;
  /// Returns the vehicle that the camera shows; empty: none in particular.
  virtual std::string subject() const { return ""; }
};

/// Makes a camera: `all` (every vehicle in view), `top` or `top:VEHICLE` (from above, north is up), `chase:VEHICLE`,
/// `orbit:VEHICLE`, `from:VEHICLE/CAMERA`, or a file of key poses, *.yaml.  `like`: size, field of view, rays per pixel
/// and water.  `world` must outlive it.  Throws CameraError, and sim::ConfigError for a file.
std::unique_ptr<CameraRig> make_camera_rig(const std::string& text, const sim::World& world, const SceneView& like);

/// Returns the view of a camera of a vehicle, `VEHICLE/CAMERA` or `VEHICLE.CAMERA`, at its present pose: its lens and
/// exposure, without noise, blur and rolling shutter.  Throws CameraError.
SceneView view_of_camera(const sim::World& world, const std::string& name);

/// Returns the name of the first camera of a vehicle, or of the world when `vehicle` is empty; empty: there is none.
std::string first_camera(const sim::World& world, const std::string& vehicle);

}  // namespace viewer
