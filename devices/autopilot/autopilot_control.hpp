// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/param_reader.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// A craft with fins that is slower is steered as if it had this speed.
inline constexpr double slowest_mps = 0.5;

/// How fast a quantity is brought to its set value.
struct HoldGains {
  double bandwidth_radps = 0.5;
  double damping = 1;
  double rate_max = 0.5;  ///< m/s or rad/s
  double integral = 0.1;  ///< 0: none
  void read(sim::ParamReader& in);
};

/// Holds a quantity x of a plant x'' = a + d, d an unknown constant: PID by placed poles (Fossen, Handbook of Marine
/// Craft Hydrodynamics and Motion Control, 2021, algorithm 15.1), as a cascade, so that the rate stays in bounds:
///   a = 2 zeta w (clamp(w / (2 zeta) e, rate_max) - x') + integral w^3 (sum of e dt).
/// The sum is stable for integral < 2 zeta.
class AxisHold {
 public:
  explicit AxisHold(const HoldGains& gains) : gains_(gains) {}

  /// The acceleration to ask for.  `error`: wanted less true; `rate`: x'.  `frozen`: the integral of the error is
  /// held (anti-windup), as the actuators are saturated.
  double step(double error, double rate, double dt_s, bool frozen);
  void reset() { sum_ = 0; }
  void visit_state(sim::StateArchive& archive) { archive(sum_); }

 private:
  HoldGains gains_;
  double sum_ = 0;  ///< acceleration
};

/// Holds the rate itself, of a plant v' = a + d: a = w e + integral w^2 (sum of e dt).
class RateHold {
 public:
  RateHold(double bandwidth_radps, double integral) : bandwidth_radps_(bandwidth_radps), integral_(integral) {}

  double step(double error, double dt_s, bool frozen);
  void reset() { sum_ = 0; }
  void visit_state(sim::StateArchive& archive) { archive(sum_); }

 private:
  double bandwidth_radps_;
  double integral_;
  double sum_ = 0;
};

}  // namespace devices
