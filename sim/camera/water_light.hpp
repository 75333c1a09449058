// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/camera/sky_light.hpp"
#include "sim/camera/texture.hpp"

namespace sim {

/// Rays from a camera that are lit together, one element of each array for each ray: all of them are computed, whether
/// used or not, so that the compiler makes vector loops.
struct WaterRays {
  static constexpr int size = 64;
  using Values = float[size];

  alignas(32) Values direction_W[3] = {};
  Values range_m = {};     ///< of what is seen; infinity: nothing
  Values crossing_m = {};  ///< range at which the ray crosses the surface; infinity: not at all
  /// Slope of the surface there to the east and north, and mean square slope of what the grids do not show.
  Values slope_x = {}, slope_y = {}, rough = {};
  /// Red, green and blue: before, of what is seen, in daylight at the surface; after, of the ray.
  Values light[3] = {};
};

/// Light in the water around a camera.
struct WaterLight {
  LinearColor attenuation = LinearColor::Zero();  ///< of a beam, 1/m
  LinearColor downward = LinearColor::Zero();     ///< of daylight with depth, 1/m
  LinearColor at_surface = LinearColor::Zero();   ///< daylight scattered per meter at the surface
  LinearColor at_eye = LinearColor::Zero();       ///< and at the camera
  LinearColor sun = LinearColor::Zero();          ///< above the water
  float wind_slope = 0;                           ///< mean square slope of ripples
  float eye_depth_m = 0;                          ///< of the camera under the still surface; negative: above it
  bool is_under = false;                          ///< whether the camera is under water
};

/// Returns the share of daylight that reaches a depth under the still surface.
LinearColor daylight_at(const WaterLight& water, float depth_m);

/// Replaces the light of what the rays see by that of the rays, with reflections at the surface, the light of the water
/// and its absorption.
void light_water(const WaterLight& water, const SkyLight& sky, WaterRays& rays);

}  // namespace sim
