// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>
#include <string>

#include "devices/joint/joint_servo.hpp"
#include "shoal/joint_command_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/message_codec.hpp"

namespace devices {

void JointServoController::receive(sim::Time, std::span<const std::byte> payload) {
  using shoal::Finite;
  // A program for a joint_motor can also drive a servo; the fingerprints tell the two commands apart.
  if (shoal::fingerprint(payload) == shoal::fingerprint_of<shoal::joint_command_t>()) {
    servo_.set_velocity(shoal::decode<shoal::joint_command_t>(payload, Finite::required).velocity);
    return;
  }
  const auto command = shoal::decode<shoal::joint_servo_command_t>(payload, Finite::required);
  switch (command.mode) {
    case 0:
      return servo_.set_position(command.position);
    case 1:
      return servo_.set_velocity(command.velocity);
    case 2:
      return servo_.set_effort(command.effort);
    case 3:
      return servo_.coast();
    case 4:
      return servo_.reset();
    default:
      throw std::runtime_error("'mode' must be 0 (position), 1 (velocity), 2 (effort), 3 (coast) or 4 (reset), got " +
                               std::to_string(static_cast<int>(command.mode)));
  }
}

SHOAL_ACTUATOR("joint_servo", JointServo, JointServoController);

}  // namespace devices
