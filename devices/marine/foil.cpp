// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/foil.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace devices {

void FoilParams::read(sim::ParamReader& in) {
  in.read("aspect_ratio", aspect_ratio, sim::above_to(0, 100), "square of the span over the area");
  in.read("lift_slope", lift_slope, sim::between(0, 20),
          "dC_L/d(angle), per rad; unset: pi AR / (1 + sqrt(1 + (AR/2)^2))");
  in.read_deg("stall_deg", stall_rad, sim::above_to(0, 89), "angle of attack at which the flow starts to separate");
  in.read_deg("stall_width_deg", stall_width_rad, sim::above_to(0, 89),
              "width of the transition from there to a plate across the flow");
  in.read("drag_coefficient", drag_coefficient, sim::between(0, 10), "C_D without lift");
  in.read("span_efficiency", span_efficiency, sim::above_to(0, 2), "Oswald efficiency e of the induced drag");
  in.read("plate_coefficient", plate_coefficient, sim::between(0, 3), "C_D when it is perpendicular to the flow");
}

double FoilParams::slope() const {
  // Lift slope of a low-aspect-ratio wing without sweep (Whicker & Fehlner 1958).
  return lift_slope.value_or(std::numbers::pi * aspect_ratio / (1 + std::sqrt(1 + aspect_ratio * aspect_ratio / 4)));
}

Eigen::Vector2d Foil::force(double mx, double my, double angle_rad) const {
  // Angle of attack, with the chord pointing forward along the motion.
  const double cx = std::cos(angle_rad), cy = std::sin(angle_rad);
  double sine = mx * cy - my * cx, cosine = mx * cx + my * cy;
  if (cosine < 0) {
    sine = -sine;
    cosine = -cosine;
  }
  const double attack = std::atan2(sine, cosine);
  // Attached flow: lift and induced drag.
  double C_L = slope_ * attack;
  double C_D =
      params_.drag_coefficient + C_L * C_L / (std::numbers::pi * params_.span_efficiency * params_.aspect_ratio);
  // Blend with the normal force of a plate past the stall.
  const double past = std::min((std::abs(attack) - params_.stall_rad) / params_.stall_width_rad, 1.0);
  if (past > 0) {
    const double stalled = past * past * (3 - 2 * past);
    const double C_N = params_.plate_coefficient * sine * sine;
    C_L += stalled * (std::copysign(C_N * cosine, sine) - C_L);
    C_D += stalled * (params_.drag_coefficient + C_N * std::abs(sine) - C_D);
  }
  // Drag opposes the motion; lift is perpendicular to it.
  return {-C_D * mx - C_L * my, -C_D * my + C_L * mx};
}

}  // namespace devices
