// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "devices/inertial/inertial_errors.hpp"

namespace devices {

/// Named inertial unit with the errors of its data sheet.
struct ImuPreset {
  std::string name;
  InertialParams gyro;   ///< rad/s
  InertialParams accel;  ///< m/s^2
};

/// Returns all presets, `ideal` first.
const std::vector<ImuPreset>& imu_presets();

/// Conversion factors from data sheet units to SI units.
namespace unit {
inline constexpr double mps2_per_g = 9.80665;  ///< standard gravity, independent of the gravity of the world
inline constexpr double degps = sim::degrees_to_radians(1);
inline constexpr double deg_per_h = degps / 3600;
inline constexpr double deg_per_sqrt_h = degps / 60;  ///< angle random walk, in rad / sqrt(s)
inline constexpr double deg_per_h_per_sqrt_h = degps / 3600 / 60;
inline constexpr double mps_per_sqrt_h = 1.0 / 60;  ///< velocity random walk, in m / s / sqrt(s)
inline constexpr double mg = 1e-3 * mps2_per_g;
inline constexpr double ug = 1e-6 * mps2_per_g;
inline constexpr double ug_per_sqrt_h = ug / 60;
inline constexpr double ppm = 1e-6;
inline constexpr double mrad = 1e-3;
}  // namespace unit

}  // namespace devices
