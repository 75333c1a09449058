// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/drive/two_sided_drive.hpp"

namespace devices {

/// Differential drive: two driven wheels on one axle.
class DifferentialDrive final : public TwoSidedDrive {
 public:
  static constexpr const char* meaning =
      "Two driven wheels, commanded by wheel speeds, by forward speed and turn rate, or by thrust and rudder.";
  static constexpr bool acts_alone = true;
  static constexpr const char* fixed_keys[] = {"left_joint", "right_joint"};
  struct Params {
    std::string left_joint;
    std::string right_joint;
    TwoSidedDrive::Params drive;
    void read(sim::ParamReader& in);
  };

  DifferentialDrive(const Params& params, const sim::DeviceContext& context)
      : TwoSidedDrive(params.drive, context, {params.left_joint}, {params.right_joint}) {}
  void change(const Params& params) { change_drive(params.drive); }
};

/// Receives shoal.wheel_speeds_command_t, shoal.twist_command_t or shoal.thrust_rudder_command_t, distinguished by
/// their fingerprints.
class DifferentialDriveController final : public sim::Controller {
 public:
  static constexpr const char* command_messages =
      "shoal.twist_command_t, shoal.wheel_speeds_command_t, shoal.thrust_rudder_command_t";
  explicit DifferentialDriveController(TwoSidedDrive& drive) : drive_(drive) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  TwoSidedDrive& drive_;
};

}  // namespace devices
