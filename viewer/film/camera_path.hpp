// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace viewer {

/// Camera of a film at one time.
struct CameraKey {
  double at_s = 0;  ///< simulated time
  sim::Vector3d eye_m = sim::Vector3d::Zero();
  sim::Vector3d look_m = sim::Vector3d::Zero();
  double fov_rad = sim::degrees_to_radians(60);

  void read(sim::ParamReader& in);
};

/// Path of a camera through key poses, at increasing times.
struct CameraPath {
  std::string follow;           ///< vehicle to whose position the keys are relative; empty: the world
  std::vector<CameraKey> keys;  ///< at least one

  void read(sim::ParamReader& in);
  /// Returns the camera at a time: cubic between the keys (Catmull-Rom), and constant before and after them.
  CameraKey at(double time_s) const;
};

/// Reads a file of a camera path.  Throws sim::ConfigError with the place of each mistake.
CameraPath read_camera_path(const std::string& file);

}  // namespace viewer
