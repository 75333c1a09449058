// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <span>

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
  /// Red, green and blue: light that lamps throw on what is seen and that it reflects, at its place.
  Values lit[3] = {};
};

/// Lamp in the world's directions, relative to the camera; see Lamp.
struct LampLight {
  Eigen::Vector3f position_W = Eigen::Vector3f::Zero();
  Eigen::Vector3f axis_W = Eigen::Vector3f::UnitX();
  LinearColor color = LinearColor::Ones();
  float spread = 1;
};

/// Light in the water around a camera.
struct WaterLight {
  LinearColor attenuation = LinearColor::Zero();  ///< of a beam, 1/m
  LinearColor downward = LinearColor::Zero();     ///< of daylight with depth, 1/m
  LinearColor particles = LinearColor::Zero();    ///< scattering of particles, 1/m
  LinearColor molecules = LinearColor::Zero();    ///< scattering of the water itself, 1/m
  LinearColor at_surface = LinearColor::Zero();   ///< daylight scattered per meter at the surface
  LinearColor at_eye = LinearColor::Zero();       ///< and at the camera
  LinearColor sun = LinearColor::Zero();          ///< above the water
  float wind_slope = 0;                           ///< mean square slope of ripples
  float eye_depth_m = 0;                          ///< of the camera under the still surface; negative: above it
  bool is_under = false;                          ///< whether the camera is under water
};

/// Returns the light of a lamp on a surface that faces it, at a place relative to the camera, after the water between.
inline LinearColor lamp_light_at(const WaterLight& water, const LampLight& lamp, const Eigen::Vector3f& p_W) {
  constexpr float nearest_m = 0.02F;
  const Eigen::Vector3f way = p_W - lamp.position_W;
  const float distance_m = std::max(way.norm(), nearest_m);
  const float off_axis = 1 - way.dot(lamp.axis_W) / distance_m;
  const float strength = std::exp(-lamp.spread * off_axis) / (distance_m * distance_m);
  return lamp.color.cwiseProduct((-distance_m * water.attenuation).array().exp().matrix()) * strength;
}

/// Returns the share of daylight that reaches a depth under the still surface.
LinearColor daylight_at(const WaterLight& water, float depth_m);

/// Replaces the light of what the rays see by that of the rays, with reflections at the surface, the light of the water
/// and its absorption.
void light_water(const WaterLight& water, const SkyLight& sky, WaterRays& rays);

/// Adds the light of lamps, after light_water(): that on what is seen, and that which the water scatters into the rays
/// of a camera under water.  Light is scattered once, by particles with the phase function of Henyey and Greenstein
/// (1941) for g = 0.924 (Mobley et al. 1993), by the water itself equally in all directions.  The integral over the
/// path is a sum over equal angles seen from the lamp (Kulla and Fajardo 2012).
void light_lamps(const WaterLight& water, std::span<const LampLight> lamps, WaterRays& rays);

}  // namespace sim
