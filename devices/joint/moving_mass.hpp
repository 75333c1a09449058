// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/common/actuator_commands.hpp"
#include "devices/common/actuator_lag.hpp"
#include "sim/physics/body.hpp"
#include "sim/world/world.hpp"

namespace devices {

/// A mass inside the vehicle that moves and so shifts its weight: the battery of a glider.  The vehicle's own numbers
/// have it at the command 0.
///
/// - slide: along x of the device frame D; the command is the way in m.  Forwards turns the nose down.
/// - turn: about x of D, hanging along -z at a radius; the command is an angle in rad.  Positive swings it to +y, which
///   rolls the vehicle to port.
///
/// What acts is the moment of its weight in the attitude of this moment.  What is left out: the force that moves it,
/// its own inertia about the new place, and its part in centrifugal forces; all are small for a mass that moves slowly.
class MovingMass final : public sim::Actuator {
 public:
  static constexpr const char* meaning =
      "Mass inside the vehicle that slides along (command in m) or turns about x of its frame (rad).";
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::hold, sim::SafeState::stop};
  static constexpr const char* fixed_keys[] = {"motion"};
  enum class MassMotion { slide, turn };
  struct Params {
    MassMotion motion = MassMotion::slide;
    double mass_kg = 9;
    double max_m = 0.05;
    std::optional<double> min_m;
    double rate_mps = 0.01;
    double radius_m = 0.02;
    double limit_rad = sim::degrees_to_radians(60);
    double rate_degps = 10;
    LagParams lag;
    void read(sim::ParamReader& in);
    double upper() const { return motion == MassMotion::slide ? max_m : limit_rad; }
    double lower() const { return motion == MassMotion::slide ? min_m.value_or(-max_m) : -limit_rad; }
  };

  MovingMass(const Params& params, const sim::DeviceContext& context);
  /// `effectiveness` slows its motor; at 0 it stays where it is.
  void act(const sim::ActContext& context) override;
  /// hold: it stays where it is; stop: to 0.
  void make_safe(sim::SafeState safe) override;
  void change(const Params& params);
  void visit_state(sim::StateArchive& archive) override;

  /// m or rad, by `motion`; beyond the limits it is cut.
  void set_command(double command);
  double place() const { return lag_.value(); }

 private:
  sim::Vector3d offset_D(double place) const;

  Params params_;
  const sim::World& world_;
  sim::Body& body_;
  sim::Matrix3d R_BD_;
  Lag lag_;
  double desired_ = 0;
};

}  // namespace devices
