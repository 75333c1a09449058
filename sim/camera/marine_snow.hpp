// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "sim/base/math.hpp"
#include "sim/camera/optics.hpp"
#include "sim/camera/texture.hpp"
#include "sim/camera/water_light.hpp"
#include "sim/image/image.hpp"

namespace sim {

/// Particles in the water before a camera: discs of 0.5 to 2 mm, as many in each cell of a grid that sinks at the speed
/// of marine snow (74 m in a day, Alldredge and Gotschalk 1988).  Each is a function of the seed and its cell, so that
/// all cameras of a run see the same ones.  They do not drift with the current.
class MarineSnow {
 public:
  MarineSnow(double per_m3, std::uint64_t seed) : per_m3_(per_m3), seed_(seed) {}

  /// Image, and what is seen in it.
  struct Target {
    FloatImage& light;
    const FloatImage& depth_m;
    bool depth_along_ray = false;
    int first = 0, end = 0;  ///< rows
    float weight = 1;        ///< of this exposure
    /// Particles before it, along the axis of the lens, are in a housing.
    double port_m = std::numeric_limits<double>::lowest();
  };

  bool empty() const { return per_m3_ <= 0; }
  /// Draws the particles at a time into rows of an image.  `daylight`: on a surface that faces up, at the camera.
  /// `lamps`: relative to the camera.
  void draw(const Pose& X_WS, double time_s, const Optics& optics, double refraction, const WaterLight& water,
            const LinearColor& daylight, std::span<const LampLight> lamps, const Target& target) const;

 private:
  double per_m3_;
  std::uint64_t seed_;
};

}  // namespace sim
