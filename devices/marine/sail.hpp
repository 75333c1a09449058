// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/common/actuator_commands.hpp"
#include "devices/common/actuator_lag.hpp"
#include "devices/marine/foil.hpp"
#include "devices/marine/water_mount.hpp"

namespace devices {

/// Sail on a boom.  The mast is z of the device frame D, whose origin is the center of effort; the boom points along -x
/// when the sheet is hauled in.  The command is the length of the sheet as the maximum angle of the boom to either
/// side, rad.  A boom within this angle is aligned with the wind, and the sail has drag only.
///
/// The sail is a foil in the apparent wind, the true wind minus the velocity of the sail, see Foil.
class Sail final : public sim::Actuator {
 public:
  static constexpr const char* meaning =
      "Sail in the apparent wind; commanded by the angle in rad that its sheet allows.";
  static constexpr bool acts_alone = true;
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::stop, sim::SafeState::hold};
  static constexpr const char* fixed_keys[] = {"initial_deg"};
  struct Params {
    double area_m2 = 1;
    FoilParams foil{.aspect_ratio = 4,
                    .lift_slope = {},
                    .stall_rad = sim::degrees_to_radians(18),
                    .stall_width_rad = sim::degrees_to_radians(15),
                    .drag_coefficient = 0.05,
                    .span_efficiency = 0.9,
                    .plate_coefficient = 1.2};
    double limit_rad = sim::degrees_to_radians(85);
    double initial_rad = sim::degrees_to_radians(85);
    double rate_degps = 20;
    LagParams lag;
    void read(sim::ParamReader& in);
  };

  Sail(const Params& params, const sim::DeviceContext& context);
  /// `effectiveness` scales the rate of the winch; at 0 the sheet is stuck.
  void act(const sim::ActContext& context) override;
  /// stop: the sheet is let out; hold: present length.
  void make_safe(sim::SafeState safe) override;
  void change(const Params& params);
  void visit_state(sim::StateArchive& archive) override;

  /// Sets the angle of the sheet in rad; clamped to 0 and the limit.
  void set_command(double sheet_rad);
  double sheet_rad() const { return lag_.value(); }

 private:
  Params params_;
  WaterMount mount_;
  Foil foil_;
  Lag lag_;
  double desired_rad_ = 0;
};

}  // namespace devices
