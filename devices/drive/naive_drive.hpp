// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Kinematic drive: moves a kinematic body by helm commands, without forces, with first-order response in speed and in
/// turn rate, and without gravity and contacts.  The marine vehicle with the lowest cost, for simulations with
/// thousands of vehicles. Speed and turn rate approach their targets with their time constants; the path angle follows
/// from the depth controller or the elevator; the vehicle drifts with the current.  Depth is measured from the still
/// surface.  The vehicle does not rise out of the water: it levels out below the surface.  Roll is zero.
class NaiveDrive final : public sim::Actuator {
 public:
  static constexpr const char* meaning =
      "Moves a kinematic body by speed, heading and depth, or by thrust, rudder and elevator; no forces.";
  static constexpr bool acts_alone = true;
  static constexpr const char* example = "body: ghost";
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::stop, sim::SafeState::hold};
  struct Params {
    double max_speed_mps = 2;
    double max_astern_mps = 0;
    double speed_time_constant_s = 2;
    double max_turn_rate_radps = 0.25;
    double turn_time_constant_s = 1;
    double steerage_speed_mps = 0.5;
    double max_pitch_rad = 0.5;
    double heading_gain_per_s = 0.5;
    double depth_gain_per_s = 0.2;
    double rise_mps = 0;
    bool surface = false;
    bool drifts = true;
    double start_speed_mps = 0;
    void read(sim::ParamReader& in);
  };

  NaiveDrive(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  void act(const sim::ActContext& context) override;
  void make_safe(sim::SafeState safe) override;
  void visit_state(sim::StateArchive& archive) override;

  /// Commands speed, heading and depth.  NaN keeps a setpoint.  In water a depth below 0 is set to 0.
  void set_helm(double speed_mps, double heading_rad, double depth_m);
  /// Commands the controls, each from -1 to 1; positive rudder turns counter-clockwise, positive elevator causes a
  /// dive.
  void set_controls(double thrust, double rudder, double elevator);
  bool surface() const { return params_.surface; }

 private:
  struct Path {
    double forward_mps, climb_mps, pitch_rad;
  };
  double desired_turn(double speed_share) const;
  double surface_over_m() const;
  double desired_climb(double surface_m) const;
  Path path(double surface_m);
  void take_pose();
  void check_current();

  // Data of each step, contiguous in memory.
  sim::Body& body_;
  const sim::World& world_;
  const sim::WorldWarnings& warnings_;
  double still_surface_m_;  // without tide and waves; without water the zero height of the world
  double speed_mps_, turn_radps_ = 0, climb_mps_ = 0;
  double yaw_rad_ = 0, pitch_rad_ = 0;
  sim::Vector3d p_WB_ = sim::Vector3d::Zero();
  sim::Pose X_WB_ = sim::Pose::Identity();  // last pose set; another pose means that the body was moved
  double speed_target_mps_;
  double heading_target_rad_ = std::numeric_limits<double>::quiet_NaN();  // NaN: by rudder
  double depth_target_m_ = std::numeric_limits<double>::quiet_NaN();      // NaN: by elevator
  double rudder_ = 0, elevator_ = 0;
  bool left_the_current_ = false;                         // has been reported
  double step_s_ = 0, speed_share_ = 0, turn_share_ = 0;  // share of the remaining difference covered in a step
  double max_sine_ = 0;                                   // of the pitch
  /// Angle with its cosine and sine, computed when the angle changes.
  struct Turned {
    double angle_rad = 0, cosine = 1, sine = 0;
    void turn_to(double angle) {
      if (std::bit_cast<std::uint64_t>(angle) == std::bit_cast<std::uint64_t>(angle_rad)) return;  // -0 is not 0 here
      angle_rad = angle;
      cosine = std::cos(angle);
      sine = std::sin(angle);
    }
  };
  Turned yaw_, pitch_;
  Params params_;
};

/// Receives shoal.helm_command_t, shoal.thrust_rudder_elevator_command_t or shoal.thrust_rudder_command_t.
class NaiveDriveController final : public sim::Controller {
 public:
  static constexpr const char* command_messages =
      "shoal.helm_command_t, shoal.thrust_rudder_elevator_command_t, shoal.thrust_rudder_command_t";
  explicit NaiveDriveController(NaiveDrive& drive) : drive_(drive) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  NaiveDrive& drive_;
};

}  // namespace devices
