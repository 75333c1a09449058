// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "devices/common/actuator_commands.hpp"
#include "devices/common/actuator_lag.hpp"
#include "devices/marine/foil.hpp"
#include "devices/marine/water_mount.hpp"
#include "sim/model/hydrodynamics_config.hpp"

namespace devices {

/// Published coefficients: force and moment about the origin of the body per rad of deflection and (m/s)^2 of forward
/// speed.
struct FinCoefficients {
  sim::Vector3d force = sim::Vector3d::Zero();  ///< forward-left-up axes of the body
  sim::Vector3d moment = sim::Vector3d::Zero();
  void read(sim::ParamReader& in);
};

/// Rudder, stern plane or bow plane.  In the device frame D, x is forward along the chord at rest and z is the hinge
/// axis.  A command is an angle in rad; a positive angle turns the leading edge from x towards y, and with flow from
/// ahead the lift is along +y.
///
/// - A rudder at the stern, mounted with `rpy_deg: [0, 0, 0]`: positive turns the vehicle to starboard (as delta_r of
///   MSS).  `rpy_deg: [180, 0, 0]`: to port.
/// - A stern plane, `rpy_deg: [90, 0, 0]`: the lift is upwards, positive turns the nose down (as delta_s of MSS and of
///   Prestero).  `rpy_deg: [-90, 0, 0]`: nose up.
///
/// Lift and drag are those of a foil, see Foil.
class Fin final : public sim::Actuator {
 public:
  static constexpr const char* meaning =
      "Rudder or plane that turns about z of its frame; commanded by its angle in rad.";
  static constexpr bool acts_alone = true;
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::stop, sim::SafeState::hold};
  /// Force model: foil, or published coefficients.
  enum class Model { lift, coefficients };
  /// Flow of the foil model: at the fin, or at the origin of the body.
  enum class Flow { local, body };
  struct Params {
    Model model = Model::lift;
    Flow flow = Flow::local;
    double area_m2 = 0.01;
    std::optional<double> density_kgpm3;
    double limit_rad = sim::degrees_to_radians(30);
    FoilParams foil;
    std::optional<FinCoefficients> coefficients;
    std::optional<double> rate_limit_degps;
    LagParams lag;
    void read(sim::ParamReader& in);
  };

  Fin(const Params& params, const sim::DeviceContext& context);
  /// `effectiveness` scales the rate of the servo; at 0 the fin is stuck.
  void act(const sim::ActContext& context) override;
  /// stop: amidships; hold: present angle.
  void make_safe(sim::SafeState safe) override { command_ = safe == sim::SafeState::hold ? lag_.value() : 0; }
  void change(const Params& params);
  void visit_state(sim::StateArchive& archive) override { archive(lag_, command_); }

  /// Sets the angle in rad; clamped to the limit.
  void set_command(double angle_rad);
  double angle_rad() const { return lag_.value(); }

 private:
  void lift_locally(const WaterFlow& flow, double angle_rad, double scale, double step_s);
  void lift_by_speed_of_body(const WaterFlow& flow, double angle_rad, double scale, double step_s);
  void act_as_published(const WaterFlow& flow, double angle_rad, double scale, double step_s);

  // Members of each step together.
  double command_ = 0;
  double span_m_ = 0;
  double max_coefficient_ = 1;  // norm of force or moment per rad and (m/s)^2
  Lag lag_;
  WaterMount mount_;
  Foil foil_;
  Params params_;
};

}  // namespace devices
