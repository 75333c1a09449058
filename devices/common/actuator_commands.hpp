// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "shoal/actuator_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "sim/device/device.hpp"

namespace devices {

/// Controller of an actuator commanded by one number: receives shoal.actuator_command_t.
template <typename Model>
class NumberController : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.actuator_command_t";
  explicit NumberController(Model& model) : model_(model) {}
  void receive(sim::Time, std::span<const std::byte> payload) override {
    model_.set_command(shoal::decode<shoal::actuator_command_t>(payload, shoal::Finite::required).value);
  }

 private:
  Model& model_;
};

}  // namespace devices
