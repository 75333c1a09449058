// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/param_reader.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// Lower limit of the speed in the control laws of fins, whose effect vanishes with the speed.
inline constexpr double slowest_mps = 0.5;

/// Gains of the control of one quantity.
struct HoldGains {
  double bandwidth_radps = 0.5;
  double damping = 1;
  double rate_max = 0.5;  ///< limit of the rate, m/s or rad/s
  double integral = 0.1;  ///< integral gain; 0: none
  void read(sim::ParamReader& in);
};

/// Controls a quantity x of a plant x'' = a + d with an unknown constant disturbance d: PID control by pole placement
/// (Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control, 2021, algorithm 15.1), as a cascade that limits
/// the rate:
///   a = 2 zeta w (clamp(w / (2 zeta) e, rate_max) - x') + integral w^3 (sum of e dt).
/// The loop is stable for integral < 2 zeta.
class AxisHold {
 public:
  explicit AxisHold(const HoldGains& gains) : gains_(gains) {}

  /// Returns the commanded acceleration.  `error`: desired minus actual value; `rate`: x'.  `frozen`: the actuators are
  /// saturated and the integral is held (anti-windup).
  double step(double error, double rate, double dt_s, bool frozen);
  /// Clears the integral term.
  void reset() { sum_ = 0; }
  void visit_state(sim::StateArchive& archive) { archive(sum_); }

 private:
  HoldGains gains_;
  double sum_ = 0;  ///< integral term, an acceleration
};

/// Controls the velocity v of a plant v' = a + d (PI control): a = w e + integral w^2 (sum of e dt).
class RateHold {
 public:
  RateHold(double bandwidth_radps, double integral) : bandwidth_radps_(bandwidth_radps), integral_(integral) {}

  /// Returns the commanded acceleration.  `frozen`: the integral is held (anti-windup).
  double step(double error, double dt_s, bool frozen);
  /// Clears the integral term.
  void reset() { sum_ = 0; }
  void visit_state(sim::StateArchive& archive) { archive(sum_); }

 private:
  double bandwidth_radps_;
  double integral_;
  double sum_ = 0;
};

}  // namespace devices
