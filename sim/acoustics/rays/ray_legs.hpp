// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/acoustics/rays/sound_profile.hpp"

namespace sim {

// A ray has one constant, cos(angle) / c = xi (Snell), and at each depth the sine s = sqrt(1 - xi^2 c^2) of its angle
// to the horizontal.  In a layer with c linear in the depth it is an arc of a circle.

/// Sine of the angle of a ray; 0 beyond its turning point.
inline double ray_sine(double xi, double c_mps) {
  return std::sqrt(std::max(0.0, (1 - xi * c_mps) * (1 + xi * c_mps)));
}

/// Part of a ray: horizontal length, and its derivative by xi.
struct RayReach {
  double r_m = 0, by_xi = 0;
  RayReach& operator+=(const RayReach& other) {
    r_m += other.r_m;
    by_xi += other.by_xi;
    return *this;
  }
  friend RayReach operator+(RayReach a, const RayReach& b) { return a += b; }
  friend RayReach operator-(const RayReach& a, const RayReach& b) { return {a.r_m - b.r_m, a.by_xi - b.by_xi}; }
  friend RayReach operator*(double times, const RayReach& a) { return {times * a.r_m, times * a.by_xi}; }
};

/// Reach of an arc between two depths of one layer `thick_m` apart, which also holds without a gradient.
inline RayReach arc_reach(double xi, double thick_m, double c1_mps, double s1, double c2_mps, double s2) {
  const double s1s2 = s1 * s2, by_xi = thick_m * (c1_mps + c2_mps) / std::max((s1 + s2) * s1s2, 1e-300);
  // Beyond this the product of both sines is not exact.
  if (s1s2 > 1e-100) return {xi * by_xi * s1s2, by_xi};
  return {xi * thick_m * (c1_mps + c2_mps) / std::max(s1 + s2, 1e-300), by_xi};
}

/// Reach of an arc from a depth to its turning point, in a layer with this gradient.
inline RayReach turn_reach(double xi, double gradient, double s) {
  const double g = std::max(std::abs(gradient), 1e-300);
  return {s / (xi * g), -1 / (xi * xi * g * std::max(s, 1e-300))};
}

/// Travel time of the arc of arc_reach(), s.
double arc_time_s(double xi, double thick_m, double c1_mps, double s1, double c2_mps, double s2);
/// Travel time of the arc of turn_reach(), s.
double turn_time_s(double gradient, double s);

/// Depths between which rays are sought.
struct RayDepths {
  /// Makes them from depths in the water, with `upper_m` <= `lower_m` <= `water_m`.
  RayDepths(const SoundProfile& profile, double upper_m, double lower_m, double water_m, bool has_bottom);

  double upper_m, lower_m, water_m;
  bool has_bottom;  ///< else rays that leave the profile downwards are lost
  std::size_t upper_layer, lower_layer, water_layer;
  double upper_mps, lower_mps, water_mps;
  double highest_between_mps;  ///< from upper_m to lower_m
  double highest_mps;          ///< in the whole water
};

/// Where a ray is reversed.
enum class RayEnd { turn, surface, bottom, lost };

/// A ray that swings between its upper and its lower end: reaches of the parts above, between and below two depths.
struct RayLegs {
  RayReach above, between, below;
  RayEnd upper_end = RayEnd::turn, lower_end = RayEnd::turn;
  RayReach whole() const { return above + between + below; }
};

/// Reach of the ray xi from the upper to the lower depth.
RayReach reach_between(const SoundProfile& profile, const RayDepths& depths, double xi);
/// Legs of the ray xi, which reaches both depths.
RayLegs ray_legs(const SoundProfile& profile, const RayDepths& depths, double xi);

/// Travel times of the same legs, s.
struct RayTimes {
  double above_s = 0, between_s = 0, below_s = 0;
  double whole_s() const { return above_s + between_s + below_s; }
};
RayTimes ray_times(const SoundProfile& profile, const RayDepths& depths, double xi);

}  // namespace sim
