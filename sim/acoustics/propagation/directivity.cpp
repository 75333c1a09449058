// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/directivity.hpp"

#include <math.h>  // j1 is not in <cmath>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

using Pattern = DirectivityConfig::Pattern;

/// Pressure relative to that on the axis, or in the plane normal to a line.
double piston(double x) {
  return std::abs(x) < 1e-4 ? 1 - x * x / 8 : 2 * ::j1(x) / x;
}
double line(double u) {
  return std::abs(u) < 1e-4 ? 1 - u * u / 6 : std::sin(u) / u;
}

/// Response in a direction.  `cosine`: of the angle to +x (piston, hemisphere) or to z (toroid).
Decibels gain_at(const DirectivityConfig& config, double cosine, double wave_number_pm) {
  Decibels gain;
  switch (config.pattern) {
    case Pattern::omni:
      return gain;
    case Pattern::hemisphere:
      if (cosine < 0) gain = Decibels(config.floor_dB);
      break;
    case Pattern::piston:
      gain = cosine <= 0 ? Decibels(config.floor_dB)
                         : pressure_level(piston(wave_number_pm * config.diameter_m / 2 *
                                                 std::sqrt(std::max(0.0, 1 - cosine * cosine))));
      break;
    case Pattern::toroid:
      gain = pressure_level(line(wave_number_pm * config.length_m / 2 * cosine));
      break;
  }
  return std::max(gain, Decibels(config.floor_dB));
}

}  // namespace

void DirectivityConfig::read(ParamReader& in) {
  in.read_choice("pattern", pattern,
                 {{"omni", Pattern::omni},
                  {"piston", Pattern::piston},
                  {"hemisphere", Pattern::hemisphere},
                  {"toroid", Pattern::toroid}},
                 "omni: to all sides; piston: a beam along +x; hemisphere: about +x; toroid: level about z");
  in.read("diameter_m", diameter_m, above_to(0, 10),
          "piston: a larger diameter or a higher frequency makes the beam narrower");
  in.read("length_m", length_m, above_to(0, 10),
          "toroid: length of the line along z; a longer one makes the beam flatter");
  in.read("floor_dB", floor_dB, between(-200, 0), "minimum response in any direction, relative to the axis");
  if (in.has("diameter_m") && pattern != Pattern::piston) in.error("diameter_m", "'diameter_m' is for pattern piston");
  if (in.has("length_m") && pattern != Pattern::toroid) in.error("length_m", "'length_m' is for pattern toroid");
}

Decibels directivity_gain(const DirectivityConfig& config, const Vector3d& direction_S, double frequency_Hz,
                          double sound_speed_mps) {
  const double length = direction_S.norm();
  if (config.pattern == Pattern::omni || length == 0) return {};
  const double along = config.pattern == Pattern::toroid ? direction_S.z() : direction_S.x();
  return gain_at(config, along / length, 2 * std::numbers::pi * frequency_Hz / sound_speed_mps);
}

Decibels directivity_index(const DirectivityConfig& config, double frequency_Hz, double sound_speed_mps) {
  if (config.pattern == Pattern::omni) return {};
  const double k = 2 * std::numbers::pi * frequency_Hz / sound_speed_mps;
  // Midpoint rule over the angle, fine enough to resolve every lobe.
  const int rings = 4000;
  PowerRatio sum;
  for (int i = 0; i < rings; ++i) {
    const double angle_rad = (i + 0.5) * std::numbers::pi / rings;
    sum += std::sin(angle_rad) * to_power(gain_at(config, std::cos(angle_rad), k));
  }
  return -to_decibels(std::numbers::pi / rings / 2 * sum);
}

}  // namespace sim
