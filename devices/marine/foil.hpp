// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace devices {

/// Thin symmetric foil, such as a fin or a sail, by its angle of attack a.
///
/// - attached flow: C_L = slope a, C_D = C_D0 + C_L^2 / (pi e AR) (Anderson, Fundamentals of Aerodynamics, ch. 5)
/// - stalled: C_N = c sin^2(a) normal to the chord (Beard & McLain, Small Unmanned Aircraft, eq. 4.10)
/// - smooth transition between both; leading and trailing edge are equivalent
struct FoilParams {
  double aspect_ratio = 2;
  std::optional<double> lift_slope;
  double stall_rad = sim::degrees_to_radians(15), stall_width_rad = sim::degrees_to_radians(10);
  double drag_coefficient = 0.01, span_efficiency = 0.9, plate_coefficient = 1.2;
  void read(sim::ParamReader& in);
  /// Returns the lift slope dC_L/da, 1/rad.
  double slope() const;
};

/// Forces on a foil.
class Foil {
 public:
  explicit Foil(const FoilParams& params) : slope_(params.slope()), params_(params) {}
  double slope() const { return slope_; }
  /// Returns the force divided by dynamic pressure and area.  The foil moves through the fluid along the unit vector
  /// (mx, my); `angle_rad` is the angle of its chord from x towards y.
  Eigen::Vector2d force(double mx, double my, double angle_rad) const;

 private:
  double slope_;
  FoilParams params_;
};

}  // namespace devices
