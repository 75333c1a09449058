// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "sim/base/free_numbers.hpp"
#include "sim/base/math.hpp"

namespace sim {

/// Rounded positions of the moving bodies, side by side: a search among thousands of bodies reads 16 bytes for each.
/// The positions themselves are scattered over the memory of ODE.
class BodyPlaces {
 public:
  /// Notes that all points of a body are within a distance of its position from now on.
  void set_reach(int body, double reach_m) { slot(places_, body).reach_m = static_cast<float>(reach_m); }
  /// Returns the distance of set_reach(), rounded up by 1e-5; 0 without.
  double reach_m(int body) const {
    const auto number = static_cast<std::size_t>(body);
    return number < places_.size() ? std::max(0.0, 1.00001 * places_[number].reach_m) : 0;
  }
  void remove(int body) { slot(places_, body) = {}; }
  /// Notes the position (m, x y z) of a body that has moved.  Threads may do so for different bodies that have a reach.
  void set_position(int body, const double* p_W) {
    if (static_cast<std::size_t>(body) >= places_.size()) return;
    Place& place = places_[static_cast<std::size_t>(body)];
    for (int i = 0; i < 3; ++i) place.p_W[i] = static_cast<float>(p_W[i]);
  }
  /// Calls visit(body) for the bodies that may meet a sphere, in ascending order, and perhaps for some beside it.
  template <typename Visit>
  void find_near(const Vector3d& center_W, double radius_m, const Visit& visit) const {
    // Positions near the sphere are rounded by less than this; the sums below round further.
    const double margin_m = 1e-6 * (center_W.cwiseAbs().sum() + radius_m);
    const Eigen::Vector3f center = center_W.cast<float>();
    const auto radius = static_cast<float>(1.00001 * radius_m + margin_m);
    for (std::size_t body = 0; body < places_.size(); ++body) {
      const Place& place = places_[body];
      const float x = place.p_W[0] - center.x(), y = place.p_W[1] - center.y(), z = place.p_W[2] - center.z();
      const float near = radius + 1.00001F * place.reach_m;
      if (near > 0 && !(x * x + y * y + z * z > near * near)) visit(static_cast<int>(body));
    }
  }

 private:
  struct Place {
    float p_W[3] = {0, 0, 0};
    float reach_m = -std::numeric_limits<float>::infinity();  ///< none
  };
  std::vector<Place> places_;  // by body
};

}  // namespace sim
