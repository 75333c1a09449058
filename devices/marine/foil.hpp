// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace devices {

/// A thin symmetric plate in a flow, by its angle of attack a: a fin, a sail.
///
/// - attached flow: C_L = slope a, C_D = C_D0 + C_L^2 / (pi e AR) (Anderson, Fundamentals of Aerodynamics, ch. 5)
/// - past the stall: C_N = c sin^2(a) across the chord (Beard & McLain, Small Unmanned Aircraft, eq. 4.10)
/// - between them smooth.  It has no front: flow from behind acts alike.
struct FoilParams {
  double aspect_ratio = 2;
  std::optional<double> lift_slope;
  double stall_rad = sim::degrees_to_radians(15), stall_width_rad = sim::degrees_to_radians(10);
  double drag_coefficient = 0.01, span_efficiency = 0.9, plate_coefficient = 1.2;
  void read(sim::ParamReader& in);
  /// dC_L/da, 1/rad.
  double slope() const;
};

class Foil {
 public:
  explicit Foil(const FoilParams& params) : params_(params), slope_(params.slope()) {}
  double slope() const { return slope_; }
  /// Force over dynamic pressure and area on a foil that moves through the fluid along the unit vector (mx, my), its
  /// chord at an angle from x towards y.
  Eigen::Vector2d force(double mx, double my, double angle_rad) const;

 private:
  FoilParams params_;
  double slope_;
};

}  // namespace devices
