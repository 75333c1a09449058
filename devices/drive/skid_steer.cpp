// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/skid_steer.hpp"

namespace devices {

void SkidSteer::Params::read(sim::ParamReader& in) {
  in.require("left_joints");
  in.read_references("left_joints", left_joints, "joint", "joints of the left wheels, axes to the left");
  in.require("right_joints");
  in.read_references("right_joints", right_joints, "joint", "joints of the right wheels, axes to the left");
  for (const auto& [key, joints] : {std::pair{"left_joints", &left_joints}, {"right_joints", &right_joints}})
    if (in.has(key) && joints->empty()) in.error(key, std::string("'") + key + "' must name a joint");
  drive.read(in,
             "effective track: (right - left ground speed) / turn rate as measured, wider than the wheels' own; unset: "
             "2 (b + a^2 / b) of wheels at (+-a, +-b), which is so under Coulomb friction");
}

SHOAL_ACTUATOR("skid_steer", SkidSteer, DifferentialDriveController);

}  // namespace devices
