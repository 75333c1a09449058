// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/usbl_array.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace devices {

void UsblArrayParams::read(sim::ParamReader& in) {
  in.read("baseline_m", baseline_m, sim::between(0.001, 10), "between the two hydrophones of a pair");
  in.read_deg("phase_std_deg", phase_std_rad, sim::between(0, 180),
              "standard deviation of each phase difference at any level");
}

double UsblArrayParams::cosine_std(const UsblTone& tone) const {
  const double snr = std::max(tone.snr.linear(), 1e-12);
  const double by_noise = std::sqrt((1 + 2 * snr) / (2 * snr * snr * std::max(tone.time_bandwidth, 1.0)));
  return tone.wavelength_m / (2 * std::numbers::pi * baseline_m) * std::hypot(by_noise, phase_std_rad);
}

sim::Vector3d with_cosine_errors(const sim::Vector3d& direction_S, double error_x, double error_y) {
  const double x = direction_S.x() + error_x, y = direction_S.y() + error_y;
  const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
  return sim::Vector3d(x, y, std::copysign(z, direction_S.z())).normalized();
}

sim::Vector3d turned(double azimuth_rad, double elevation_rad, double across_rad, double up_rad) {
  const double e = elevation_rad + up_rad;
  const sim::Vector3d level(std::cos(azimuth_rad), std::sin(azimuth_rad), 0);
  const sim::Vector3d left(-level.y(), level.x(), 0);
  return std::cos(across_rad) * (std::cos(e) * level + std::sin(e) * sim::Vector3d::UnitZ()) +
         std::sin(across_rad) * left;
}

}  // namespace devices
