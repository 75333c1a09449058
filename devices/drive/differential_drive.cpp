// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/differential_drive.hpp"

#include "devices/drive/drive_commands.hpp"

namespace devices {

void DifferentialDrive::Params::read(sim::ParamReader& in) {
  in.require("left_joint");
  in.read_reference("left_joint", left_joint, "joint", "hinge of the left wheel, axis to the left");
  in.require("right_joint");
  in.read_reference("right_joint", right_joint, "joint", "hinge of the right wheel, axis to the left");
  drive.read(in, "distance between the wheels; unset: as the joints have them");
}

void DifferentialDriveController::receive(sim::Time, std::span<const std::byte> payload) {
  receive_drive_command(drive_, payload);
}

SHOAL_ACTUATOR("differential_drive", DifferentialDrive, DifferentialDriveController);

}  // namespace devices
