// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/camera/texture.hpp"
#include "sim/scene/light.hpp"

namespace sim {

/// Light of the sky and of the sun in it, and of the ground below the horizon.
class SkyLight {
 public:
  explicit SkyLight(const LightConfig& light);

  bool sun_is_up() const { return sun_is_up_; }
  const Eigen::Vector3f& to_sun_W() const { return to_sun_W_; }
  const LinearColor& sun() const { return sun_; }

  /// Returns the light in a direction.
  LinearColor from(const Eigen::Vector3f& direction_W) const {
    float rgb[3];
    from(direction_W.z(), direction_W.dot(to_sun_W_), rgb);
    return {rgb[0], rgb[1], rgb[2]};
  }
  /// Sets the light in the direction with this z component and this cosine of the angle to the sun.  It has no
  /// branches, so that the compiler makes vector loops over directions.
  [[gnu::always_inline]] void from(float up, float toward, float (&rgb)[3]) const {
    // Disc of the sun and its halo.
    constexpr float disc = 0.99996F;  // cosine of half a degree: twice the angular radius of the sun
    const float near = toward > 0.9F && up > 0 ? raised_to_64(toward) : 0;
    const float halo = sun_is_up_ ? near : 0;
    const float inner = raised_to_64(halo), outer = 0.15F * halo;
    const bool on_disc = sun_is_up_ && toward > disc;
    const float root = std::sqrt(up > 0 ? up : 0), below = up < 0 ? up : 0;
    for (int i = 0; i < 3; ++i) {
      const float color = horizon_[i] + root * (zenith_[i] - horizon_[i]) - below * (ground_[i] - horizon_[i]) +
                          (inner * sun_[i] + outer * sun_[i]);
      rgb[i] = on_disc ? sun_[i] * 1.5F : color;
    }
  }

 private:
  [[gnu::always_inline]] static float raised_to_64(float x) {
    for (int i = 0; i < 6; ++i) x *= x;
    return x;
  }

  Eigen::Vector3f to_sun_W_;
  bool sun_is_up_;
  LinearColor sun_, zenith_, horizon_, ground_;
};

}  // namespace sim
