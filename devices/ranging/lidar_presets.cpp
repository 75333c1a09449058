// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/lidar_presets.hpp"

#include <array>

namespace devices {

namespace {

using sim::degrees_to_radians;

// "Checked" figures agree with the named manual, data sheet or quotation of one; "not checked" figures are unverified.

/// SICK LMS 200 in its 8 m (millimeter) mode.  Checked, documentation of Player: 180 deg in steps of 1 deg are 181
/// points, 75 Hz at 500 kbaud and 10 Hz at 38400 baud; 8.192 m in mm, 81.92 m in cm.  Not checked: standard deviation
/// 5 mm, 10 m at 10 % reflectivity, beam of 4.4 mrad (Ye and Borenstein, ICRA 2002).
LidarPreset lms200() {
  LidarPreset preset{"lms200", 181, std::numbers::pi, 75, {}};
  preset.laser.range_min_m = 0.01;
  preset.laser.range_max_m = 8.191;
  preset.laser.resolution_m = 0.001;
  preset.laser.range_std_m = 0.005;
  preset.laser.dark_range_m = 10;
  preset.laser.beam_divergence_rad = 0.0044;
  return preset;
}

/// SICK LMS 291 in its 80 m (centimeter) mode.  Checked as above; standard deviation 10 mm at 20 m reported by a user.
/// Not checked: 30 m at 10 % reflectivity, beam of 11 mrad.
LidarPreset lms291() {
  LidarPreset preset{"lms291", 181, std::numbers::pi, 75, {}};
  preset.laser.range_min_m = 0.01;
  preset.laser.range_max_m = 81.91;
  preset.laser.resolution_m = 0.01;
  preset.laser.range_std_m = 0.005;
  preset.laser.range_std_per_m = 0.00025;
  preset.laser.dark_range_m = 30;
  preset.laser.beam_divergence_rad = 0.011;
  return preset;
}

/// Hokuyo UTM-30LX.  Checked, comments of public drivers: 270 deg, 0.25 deg, 1081 points, 25 ms, 0.1 to 30 m, +-30 mm
/// to 10 m.  Not checked: standard deviation 10 mm to 10 m and 30 mm to 30 m, here 5 mm and 0.8 mm/m (9 mm at 5 m, 29
/// mm at 30 m).  Derived, not from the sheet: 10 m at 10 %, from 30 m on white paper (90 %).  Divergence: unknown; no
/// mixed pixels unless configured.
LidarPreset utm30lx() {
  LidarPreset preset{"utm30lx", 1081, degrees_to_radians(270), 40, {}};
  preset.laser.range_min_m = 0.1;
  preset.laser.range_max_m = 30;
  preset.laser.resolution_m = 0.001;
  preset.laser.range_std_m = 0.005;
  preset.laser.range_std_per_m = 0.0008;
  preset.laser.dark_range_m = 10;
  return preset;
}

/// Velodyne VLP-16.  Checked, public drivers and simulators: 16 rings 2 deg apart from -15 to 15 deg, beam of about 2.3
/// to 3 mrad.  Not checked: 100 m, 0.5 m, 5 to 20 Hz (1800 columns at 10 Hz), +-3 cm (as 1 cm), resolution 2 mm, 50 m
/// at 10 %.
Lidar3dPreset vlp16() {
  Lidar3dPreset preset{"vlp16", 16, degrees_to_radians(-15), degrees_to_radians(15), 1800, 10, {}};
  preset.laser.range_min_m = 0.5;
  preset.laser.range_max_m = 100;
  preset.laser.resolution_m = 0.002;
  preset.laser.range_std_m = 0.01;
  preset.laser.dark_range_m = 50;
  preset.laser.beam_divergence_rad = 0.003;
  return preset;
}

/// Ouster OS1, first generation, with 32 rings in the field of view of the 16 and 64.  Checked, data sheet quoted on a
/// public page: -16.6 to 16.6 deg, 512, 1024 or 2048 columns, 10 or 20 Hz, 0.8 to 120 m at 80 % and 40 m at 10 %, range
/// resolution 1.2 cm, standard deviation 1.5 to 10 cm by signal (here 1.5 cm and 0.5 mm/m), beam of 0.13 deg, strongest
/// return.
Lidar3dPreset os1_32() {
  Lidar3dPreset preset{"os1_32", 32, degrees_to_radians(-16.6), degrees_to_radians(16.6), 1024, 10, {}};
  preset.laser.range_min_m = 0.8;
  preset.laser.range_max_m = 120;
  preset.laser.resolution_m = 0.012;
  preset.laser.range_std_m = 0.015;
  preset.laser.range_std_per_m = 0.0005;
  preset.laser.dark_range_m = 40;
  preset.laser.beam_divergence_rad = degrees_to_radians(0.13);
  return preset;
}

}  // namespace

std::span<const LidarPreset> lidar_presets() {
  static const std::array presets{lms200(), lms291(), utm30lx()};
  return presets;
}

std::span<const Lidar3dPreset> lidar3d_presets() {
  static const std::array presets{vlp16(), os1_32()};
  return presets;
}

}  // namespace devices
