// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/acoustics/rays/sound_profile.hpp"

namespace sim {

/// Path of one ray, for drawings: depth at each multiple of a step in range, until it leaves the water.
struct RayTrace {
  double launch_rad = 0;
  std::vector<double> depth_m;
  int surface_bounces = 0, bottom_bounces = 0;
};
RayTrace trace_ray(const SoundProfile& profile, double source_m, double launch_rad, double water_m, double step_m,
                   int steps);

/// Where a ray is after a time: horizontal distance and depth.  It bounces off the surface, and ends at the lower end
/// of the profile.
struct RayPlace {
  double range_m = 0, depth_m = 0;
};
RayPlace ray_place(const SoundProfile& profile, double source_m, double launch_rad, double time_s);

}  // namespace sim
