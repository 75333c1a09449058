// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "devices/ranging/laser_return.hpp"

namespace devices {

/// Parameters of a planar scanner from its data sheet.
struct LidarPreset {
  std::string name;
  int beams = 0;
  double fov_rad = 0;
  double rate_hz = 0;  ///< for documentation; a preset cannot set the common key `rate_hz`
  LaserParams laser;
};
/// Returns all presets of planar scanners.
std::span<const LidarPreset> lidar_presets();

/// Parameters of a multi-ring scanner from its data sheet.
struct Lidar3dPreset {
  std::string name;
  int rings = 0;
  double lowest_rad = 0, highest_rad = 0;
  int columns = 0;
  double rate_hz = 0;  ///< for documentation
  LaserParams laser;
};
/// Returns all presets of multi-ring scanners.
std::span<const Lidar3dPreset> lidar3d_presets();

}  // namespace devices
