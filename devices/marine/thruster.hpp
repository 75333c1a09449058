// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "devices/common/actuator_commands.hpp"
#include "devices/common/actuator_lag.hpp"
#include "devices/marine/water_mount.hpp"

namespace devices {

/// Propeller with its motor.  Its thrust acts along +x of the device frame D, at the origin of D.
///
/// A command sets the level (shaft speed, effort or thrust, see `command`), with limits, dead band and lag.  A curve
/// gives the thrust at a level:
/// - quadratic: T = a |n| n - b |n| u, with a for ahead or astern and u the inflow (Fossen 2011, eq. 9.3: bilinear)
/// - table: linear between pairs of level and thrust, constant beyond them
/// - kt_kq: T = rho D^4 |n| n (K_T0 - s J), Q = rho D^5 |n| n (K_Q0 - s_Q J), J = (1 - w) u / (n D), n in turns per
///   second; astern with J = 0
/// - direct: the level is the thrust
class Thruster final : public sim::Actuator {
 public:
  static constexpr const char* meaning =
      "Propeller that pushes along +x of its frame; commanded by rpm, rad/s, effort (-1 to 1) or thrust.";
  static constexpr bool acts_alone = true;
  /// Unit of a command.
  enum class Command { effort, rpm, radps, thrust_N };
  /// Model of the thrust at a level.
  enum class Curve { quadratic, table, kt_kq, direct };
  /// Velocity for the inflow: water along the axis, speed of the body through the water, or over ground.
  enum class Inflow { water, water_speed, ground };
  /// Direction of rotation, seen from behind.
  enum class Turns { right, left };
  struct Params {
    Command command = Command::effort;
    std::optional<double> max, min;  ///< limits of the level
    double dead_band = 0;
    LagParams lag;
    std::optional<double> rate_limit;
    Curve curve = Curve::quadratic;
    double ahead = 50;
    std::optional<double> astern;
    double inflow_loss = 0;
    std::vector<double> table;  ///< pairs: level, thrust N
    double diameter_m = 0.1;
    std::optional<double> density_kgpm3;
    double k_t0 = 0.45, k_t_slope = 0.4, k_q0 = 0.05, k_q_slope = 0.04;
    std::optional<double> full_speed_rpm;
    double wake_fraction = 0, thrust_deduction = 0;
    Inflow inflow = Inflow::water;
    Turns turns = Turns::right;
    double torque_per_thrust_m = 0, torque_share = 1;
    bool ventilation = true;
    double full_power_W = 0, efficiency = 0.7;
    void read(sim::ParamReader& in);
    double upper() const { return max.value_or(1); }
    double lower() const { return min.value_or(-upper()); }
  };

  Thruster(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context) override;
  /// stop: command 0.
  void make_safe(sim::SafeState) override { command_ = 0; }
  double power_W() const override { return power_W_; }
  void change(const Params& params);
  void visit_state(sim::StateArchive& archive) override;

  /// Sets the command in the unit of `command`; clamped to the limits.
  void set_command(double command);
  double level() const { return lag_.value(); }
  double thrust_N() const { return thrust_N_; }  ///< thrust on the body in the last step

 private:
  /// Thrust and shaft torque.
  struct Effort {
    double thrust_N, shaft_torque_Nm;
  };
  double inflow_mps(const WaterFlow& flow) const;
  Effort effort_of(double level, double inflow_mps, double density_kgpm3) const;
  double thrust_in_table(double level) const;
  double turns_per_second(double level) const;

  // Members of each step together.
  double command_ = 0;  // after limits and dead band
  double thrust_N_ = 0;
  double power_W_ = 0;
  double full_thrust_N_ = 0;
  Lag lag_;
  WaterMount mount_;
  Params params_;
};

}  // namespace devices
