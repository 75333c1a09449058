// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/robots/balance_model.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace autonomy {

using Complex = std::complex<double>;

BalanceModel::Response BalanceModel::response(Complex s) const {
  const double M = wheels_kg + wheels_kgm2 / (wheel_radius_m * wheel_radius_m), ml = mass_kg * height_m;
  const double determinant = (M + mass_kg) * inertia_kgm2 - ml * ml;
  const double stiffness = ml * gravity_mps2;  // torque of gravity for a tilt
  const double tilt_by_tilt = (M + mass_kg) * stiffness / determinant;
  const double tilt_by_torque = -(M + mass_kg + ml / wheel_radius_m) / determinant;
  const double distance_by_tilt = -ml * stiffness / determinant;
  const double distance_by_torque = (inertia_kgm2 / wheel_radius_m + ml) / determinant;
  const Complex tilt = tilt_by_torque / (s * s - tilt_by_tilt);
  return {tilt, (distance_by_tilt * tilt + distance_by_torque) / s};
}

double BalanceModel::hold_torque() const {
  const double M = wheels_kg + wheels_kgm2 / (wheel_radius_m * wheel_radius_m), ml = mass_kg * height_m;
  const double total_kgm = (M + mass_kg) * wheel_radius_m;  // T = total x''
  return ml * gravity_mps2 * total_kgm / (total_kgm + ml);
}

Complex open_loop(const Balance::Params& law, const BalanceModel& model, double w_radps) {
  const double h = law.period_s;
  const Complex s(0, w_radps), late = std::exp(-s * h);  // one sample later
  const auto [tilt, speed] = model.response(s);
  const auto low_pass = [&](double time_constant_s) {
    const double part = h / (h + time_constant_s);
    return part / (1.0 - (1 - part) * late);
  };
  const Complex difference = (1.0 - late) / h;
  const Complex rate = difference * low_pass(law.rate_filter_s) * tilt;
  // The encoders report the mean rate of the wheels relative to the body over a period.
  const Complex rolled = difference * (speed / s - law.wheel_radius_m * tilt) + law.wheel_radius_m * rate;
  const Complex measured = rolled * low_pass(law.speed_filter_s);
  const Complex sum = h / (1.0 - late);
  const Complex torque =
      law.kp_Nm_per_rad * (tilt + (law.kv_rad_per_mps + law.ki_rad_per_m * sum) * measured) + law.kd_Nms_per_rad * rate;
  const Complex hold = (1.0 - late) / (s * h);
  return -torque * hold;
}

DelayMargin delay_margin(const Balance::Params& law, const BalanceModel& model) {
  constexpr int points_per_decade = 5000;
  DelayMargin margin{std::numeric_limits<double>::infinity(), 0};
  Complex before = open_loop(law, model, 1e-3);
  const double highest = std::numbers::pi / law.period_s;  // half of the sampling frequency
  for (int i = 1;; ++i) {
    const double w = 1e-3 * std::pow(10, static_cast<double>(i) / points_per_decade);
    if (w > highest) return margin;
    const Complex loop = open_loop(law, model, w);
    if ((std::abs(loop) < 1) != (std::abs(before) < 1)) {
      const double phase = std::arg(loop) + std::numbers::pi;  // from -180 degrees, 0 to 2 pi
      if (phase / w < margin.delay_s) margin = {phase / w, w};
    }
    before = loop;
  }
}

}  // namespace autonomy
