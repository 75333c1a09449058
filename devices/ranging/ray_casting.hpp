// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/scene/scene.hpp"

namespace devices {

/// Returns unit vectors that sample a cone about +x with equal solid angles, on a Fibonacci spiral from the axis
/// outwards (H. Vogel, Mathematical Biosciences 44, 1979).  A single ray is the axis.
std::vector<sim::Vector3d> cone_pattern(double half_angle_rad, int rays);

/// Returns the solid angle of the cone, sr.
double cone_solid_angle_sr(double half_angle_rad);

/// Returns the filter of the rays of a sensor.  It excludes parts of the categories `see_through` and, unless
/// `sees_own_vehicle`, the group of the sensor's vehicle.
sim::RayFilter make_ray_filter(const sim::PhysicsWorld& physics, sim::RayKind kind,
                               const std::vector<std::string>& see_through, int own_group, bool sees_own_vehicle);

/// Key whose value is a factor of the number of rays in a sample.
struct RayFactor {
  std::string key;
  double count;
};

/// Reports an error at one of the keys when a sample needs more than a million rays.
void check_rays(sim::ParamReader& in, std::span<const RayFactor> factors);

/// Returns the rate of the device from its own map; 0: every step.  Errors of the rate are reported elsewhere.
double rate_hz_of(const sim::ParamReader& in, double default_rate_hz);

}  // namespace devices
