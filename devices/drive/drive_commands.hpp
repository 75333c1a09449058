// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "shoal/ackermann_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/thrust_rudder_command_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/wheel_speeds_command_t.hpp"

namespace devices {

/// Decodes the command in a payload, identified by its fingerprint, and passes it to a drive: twist or thrust and
/// rudder, and wheel speeds or speed and steering if the drive supports them.
template <typename Drive>
void receive_drive_command(Drive& drive, std::span<const std::byte> payload) {
  using shoal::Finite;
  const std::int64_t type = shoal::fingerprint(payload);
  if constexpr (requires { drive.set_wheel_speeds(0.0, 0.0); }) {
    if (type == shoal::fingerprint_of<shoal::wheel_speeds_command_t>()) {
      const auto command = shoal::decode<shoal::wheel_speeds_command_t>(payload, Finite::required);
      return drive.set_wheel_speeds(command.left_radps, command.right_radps);
    }
  }
  if constexpr (requires { drive.set_steering(0.0, 0.0); }) {
    if (type == shoal::fingerprint_of<shoal::ackermann_command_t>()) {
      const auto command = shoal::decode<shoal::ackermann_command_t>(payload, Finite::required);
      return drive.set_steering(command.speed_mps, command.steering_rad);
    }
  }
  if (type == shoal::fingerprint_of<shoal::thrust_rudder_command_t>()) {
    const auto command = shoal::decode<shoal::thrust_rudder_command_t>(payload, Finite::required);
    return drive.set_thrust_rudder(command.thrust, command.rudder);
  }
  const auto command = shoal::decode<shoal::twist_command_t>(payload, Finite::required);
  drive.set_twist(command.forward_mps, command.turn_radps);
}

}  // namespace devices
