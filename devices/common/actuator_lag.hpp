// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/param_reader.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// Response of an actuator to its command: immediate, first-order lag, or damped second-order; limited in rate.
struct LagParams {
  double lag_s = 0;                    ///< time constant of the first-order lag
  double natural_frequency_radps = 0;  ///< natural frequency; above 0: second-order response
  double damping_ratio = 1;            ///< damping ratio of the second-order response
  void read(sim::ParamReader& in);
};

/// Filter with the exact solution for a target that is constant within a step, for any step length: in a first-order
/// lag the remaining difference decays by exp(-step/lag).
class Lag {
 public:
  /// `rate_limit`: maximum change of value() per second; infinity: no limit.
  void set(const LagParams& params, double rate_limit);
  double follow(double target, double step_s);
  /// The same; returns the value half-way, for a force that acts during the step.
  double follow_through(double target, double step_s) {
    if (target == value_ && rate_ == 0) return value_;  // at rest
    const double half_way = follow(target, step_s / 2);
    follow(target, step_s / 2);
    return half_way;
  }
  /// Sets the value immediately, with zero rate.
  void jump_to(double value);
  double value() const { return value_; }
  double rate() const { return rate_; }  ///< rate of change, 1/s
  void visit_state(sim::StateArchive& archive) { archive(value_, rate_); }

 private:
  void prepare(double step_s);

  // State transition of a step: coefficients from the difference and its rate before the step to those after it.
  double rest_of_rest_ = 0, rest_of_rate_ = 0, rate_of_rest_ = 0, rate_of_rate_ = 0;
  double prepared_for_s_ = -1;
  double rate_limit_ = 0;
  double value_ = 0;
  double rate_ = 0;
  LagParams params_;
};

}  // namespace devices
