// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/common/actuator_commands.hpp"
#include "devices/common/actuator_lag.hpp"
#include "sim/physics/body.hpp"
#include "sim/world/world.hpp"

namespace devices {

/// Moving mass inside the vehicle that shifts its center of mass, such as the battery of a glider.  The inertia of the
/// vehicle includes the mass at command 0.
/// - slide: along x of the device frame D; the command is the displacement in m.  Forward pitches the nose down.
/// - turn: about x of D, at a radius along -z; the command is an angle in rad.  Positive moves it towards +y, which
/// rolls the vehicle to port. The moment of its weight in the present attitude is applied.  The force that moves it,
/// the change of inertia with its position, and its centrifugal forces are neglected; all are small for a mass that
/// moves slowly.
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
  /// Runs one step.  `effectiveness` slows the motor; at 0 the mass holds its position.
  void act(const sim::ActContext& context) override;
  /// Applies a safe state.  hold: holds its position; stop: moves to 0.
  void make_safe(sim::SafeState safe) override;
  void change(const Params& params);
  void visit_state(sim::StateArchive& archive) override;

  /// Commands a position, m or rad by `motion`, which is limited.
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
