// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/config/param_reader.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {
struct DeviceContext;
}

namespace devices {

class AutopilotActuators;

/// Lower limit of the speed in the control laws of fins, whose effect vanishes with the speed.
inline constexpr double slowest_mps = 0.5;

/// Gains of the control of one quantity.
struct HoldGains {
  double bandwidth_radps = 0.5;
  double damping = 1;
  double rate_max = 0.5;  ///< limit of the rate, m/s or rad/s
  double integral = 0.1;  ///< bandwidth of the disturbance estimate over that of the hold; 0: none
  void read(sim::ParamReader& in);
};

/// Estimate D of the unknown disturbance d of a plant v' = given + d, from its rate v and from the acceleration that
/// its actuators gave: D' = bandwidth (v' - given - D).  What saturated actuators do not give is not counted, so that
/// the estimate converges to d from every state and cannot wind up.
class Disturbance {
 public:
  explicit Disturbance(double bandwidth_radps) : bandwidth_radps_(bandwidth_radps) {}

  /// Returns the estimate.  `given`: acceleration by the actuators since the last call; `weight`: factor of the
  /// bandwidth, 0 to 1.
  double update(double rate, double given, double dt_s, double weight = 1);
  void reset();
  void visit_state(sim::StateArchive& archive) { archive(estimate_, rate_before_); }

 private:
  double bandwidth_radps_;
  double estimate_ = 0;
  std::optional<double> rate_before_;
};

/// Controls a quantity x of a plant x'' = a + d with an unknown constant disturbance d: PD control by pole placement
/// (Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control, 2021, algorithm 15.1), as a cascade that limits
/// the rate, less an estimate D of the disturbance:
///   a = 2 zeta w (clamp(w / (2 zeta) e, rate_max) - x') - D,  D' = integral w (x'' - given - D).
/// Where the actuators give what is commanded this is the PID law with the integral gain integral w^3: D is
/// -integral w (sum of the first term - x').  While the rate is limited the estimate counts in so far as the rate is
/// missed: a long way does not fill it with the drag, and no disturbance stops the craft for good.
class AxisHold {
 public:
  explicit AxisHold(const HoldGains& gains) : gains_(gains), disturbance_(gains.integral * gains.bandwidth_radps) {}

  /// Returns the commanded acceleration.  `error`: desired minus actual value; `rate`: x'; `given`: acceleration by the
  /// actuators since the last step.
  double step(double error, double rate, double given, double dt_s);
  /// Clears the estimate of the disturbance.
  void reset() { disturbance_.reset(); }
  void visit_state(sim::StateArchive& archive) { archive(disturbance_); }

 private:
  HoldGains gains_;
  Disturbance disturbance_;
};

/// Controls the velocity v of a plant v' = a + d: a = w e - D, with D as of AxisHold (PI control).
class RateHold {
 public:
  RateHold(double bandwidth_radps, double integral)
      : bandwidth_radps_(bandwidth_radps), disturbance_(integral * bandwidth_radps) {}

  /// Returns the commanded acceleration.  `error`: desired velocity minus `velocity`; `given`: as of AxisHold.
  double step(double error, double velocity, double given, double dt_s) {
    return bandwidth_radps_ * error - disturbance_.update(velocity, given, dt_s);
  }
  /// Clears the estimate of the disturbance.
  void reset() { disturbance_.reset(); }
  void visit_state(sim::StateArchive& archive) { archive(disturbance_); }

 private:
  double bandwidth_radps_;
  Disturbance disturbance_;
};

/// Compares the gains that hold roll and pitch with the Munk moment of the craft: warns where they are too weak for the
/// speed that its thrusters reach, and notes the speed up to which they hold it level.  A craft with fins or a
/// waterline is not checked: these right it.
void check_level(AutopilotActuators& actuators, const HoldGains& attitude, const sim::DeviceContext& context);

}  // namespace devices
