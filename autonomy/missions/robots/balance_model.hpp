// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>

#include "autonomy/missions/robots/balance.hpp"

namespace autonomy {

/// Inverted pendulum on two wheels that roll without slip, linearized about its balance.  With the displacement of the
/// axle x and the tilt a from balance, both forwards, and the torque T of both motors (Lagrange's equations of body and
/// wheels):
///
///     (M + m) x'' + m l a'' = T / r        M = mass of the wheels + their inertia / r^2
///     m l x'' + J a'' = m g l a - T
struct BalanceModel {
  double mass_kg = 72.7;          ///< m: of the body
  double height_m = 0.18114;      ///< l: of its center of mass over the axle, when balanced
  double inertia_kgm2 = 8.92056;  ///< J: of the body about the axle
  double wheels_kg = 10;          ///< of both
  double wheels_kgm2 = 0.27848;   ///< of both, about the axle
  double wheel_radius_m = 0.236;  ///< r
  double gravity_mps2 = 9.80665;

  /// Response of tilt (rad) and speed (m/s) to a torque (N m), at a complex frequency (1/s).
  struct Response {
    std::complex<double> tilt, speed;
  };
  Response response(std::complex<double> s) const;
  /// Returns the torque for each rad of a tilt that is kept while it accelerates, N m: a'' = 0 in the equations above.
  double hold_torque() const;
};

/// Returns the frequency response, at `w` rad/s, of the loop opened at the torque: model, sampling, filters, both laws
/// and the zero-order hold of the torque.  The closed loop is stable while 1 + loop has no zero in the right
/// half-plane.
std::complex<double> open_loop(const Balance::Params& law, const BalanceModel& model, double w_radps);

/// Delay margin from tilt to torque: the smallest phase margin over its frequency.  For a loop that is stable without
/// delay.
struct DelayMargin {
  double delay_s = 0;
  double frequency_radps = 0;  ///< of the oscillation at the limit
};
DelayMargin delay_margin(const Balance::Params& law, const BalanceModel& model = {});

}  // namespace autonomy
