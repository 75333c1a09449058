// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/param_reader.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// Response of an actuator to its command: immediate, first-order lag, or damped second-order; limited in rate.
struct LagParams {
  double lag_s = 0;                    ///< time constant of first order
  double natural_frequency_radps = 0;  ///< above 0: second order
  double damping_ratio = 1;            ///< of second order
  void read(sim::ParamReader& in);
};

/// The solution for a target that is constant in the step, which is exact for any step: in a first-order lag the
/// remaining difference shrinks by exp(-step/lag).
class Lag {
 public:
  /// `rate_limit`: the most that value() changes in a second; infinity: no limit.
  void set(const LagParams& params, double rate_limit);
  double follow(double target, double step_s);
  /// There at once, and at rest.
  void jump_to(double value);
  double value() const { return value_; }
  double rate() const { return rate_; }  ///< of change, 1/s
  void visit_state(sim::StateArchive& archive) { archive(value_, rate_); }

 private:
  void prepare(double step_s);

  // The remaining difference and its rate after a step, from those before it.
  double rest_of_rest_ = 0, rest_of_rate_ = 0, rate_of_rest_ = 0, rate_of_rate_ = 0;
  double prepared_for_s_ = -1;
  double rate_limit_ = 0;
  double value_ = 0;
  double rate_ = 0;
  LagParams params_;
};

}  // namespace devices
