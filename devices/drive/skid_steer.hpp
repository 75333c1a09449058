// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/drive/differential_drive.hpp"

namespace devices {

/// Skid-steer drive: wheels on both sides without steering, which slip sideways in a turn.  The vehicle then turns
/// slower than expected from its geometric track; `track_m` is the effective, wider track (Mandow et al., Experimental
/// kinematics for wheeled skid-steer mobile robots, IROS 2007: the distance between the instantaneous centers of
/// rotation of the two sides).
class SkidSteer final : public TwoSidedDrive {
 public:
  static constexpr const char* meaning =
      "Driven wheels on both sides that turn by slip, commanded as a differential drive.";
  static constexpr bool acts_alone = true;
  static constexpr const char* fixed_keys[] = {"left_joints", "right_joints"};
  struct Params {
    std::vector<std::string> left_joints;
    std::vector<std::string> right_joints;
    TwoSidedDrive::Params drive;
    void read(sim::ParamReader& in);
  };

  SkidSteer(const Params& params, const sim::DeviceContext& context)
      : TwoSidedDrive(params.drive, context, params.left_joints, params.right_joints, true) {}
  void change(const Params& params) { change_drive(params.drive); }
};

}  // namespace devices
