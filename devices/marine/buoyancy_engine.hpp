// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/common/actuator_commands.hpp"
#include "devices/common/actuator_lag.hpp"
#include "devices/marine/water_mount.hpp"

namespace devices {

/// Variable buoyancy: a bladder with a pump, as in gliders and floats.  At volume 0 the vehicle has the buoyancy of its
/// `hydrodynamics`; the additional force, density times gravity times volume, acts at the origin of the device frame.
class BuoyancyEngine final : public sim::Actuator {
 public:
  static constexpr const char* meaning =
      "Changes the displaced volume; commanded by volume in m^3, or by a fraction (-1 to 1) of its limits.";
  static constexpr bool acts_alone = true;
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::hold, sim::SafeState::park, sim::SafeState::stop};
  static constexpr const char* fixed_keys[] = {"initial_m3"};
  /// Unit of a command: m^3, or a fraction of the limits.
  enum class Command { volume, fraction };
  struct Params {
    Command command = Command::volume;
    double max_m3 = 2.5e-4, min_m3 = -2.5e-4, rate_m3ps = 2e-5;
    double initial_m3 = 0;
    std::optional<double> park_m3;
    double efficiency = 0.5;
    LagParams lag;
    void read(sim::ParamReader& in);
  };

  BuoyancyEngine(const Params& params, const sim::DeviceContext& context);
  /// `effectiveness` scales the rate of the pump; at 0 the volume is constant.
  void act(const sim::ActContext& context) override;
  /// hold: the pump stops; park: to park_m3; stop: to 0.
  void make_safe(sim::SafeState safe) override;
  double power_W() const override { return power_W_; }
  void change(const Params& params);
  void visit_state(sim::StateArchive& archive) override { archive(lag_, desired_m3_, power_W_); }

  /// Sets the volume in m^3 or as a fraction, see `command`; clamped to the limits.
  void set_command(double command);
  double volume_m3() const { return lag_.value(); }

 private:
  Params params_;
  WaterMount mount_;
  Lag lag_;
  double desired_m3_ = 0;
  double power_W_ = 0;
  double height_m_ = 0;  // height over which it emerges from the water
};

}  // namespace devices
