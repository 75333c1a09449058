// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

class Bumper;

/// Emergency stop of a vehicle: while it is engaged, all actuators are in their safe states and accept no commands.
/// After the release the actuators remain there until their next command.
class EmergencyStop final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Emergency stop: engaged, all actuators of the vehicle go to safe states.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr double default_rate_hz = 10;
  static constexpr bool always_on = true;
  struct Params {
    bool engaged_at_start = false;
    std::string stops_on_touch;
    void read(sim::ParamReader& in);
  };

  EmergencyStop(const Params& params, const sim::DeviceContext& context);
  /// Engages at the start of a contact of the bumper; a release is effective until the next contact.
  void act(const sim::ActContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double, sim::Random&) override {}
  void visit_state(sim::StateArchive& archive) override { archive(touched_, engaged_); }
  void set_engaged(bool engaged);
  bool engaged() const { return engaged_; }

 private:
  Params params_;
  sim::Vehicle& vehicle_;
  const Bumper* bumper_ = nullptr;  ///< set when all devices have been built
  bool touched_ = false;
  bool engaged_ = false;  ///< as sampled
};

/// Receives shoal.estop_t.
class EmergencyStopController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.estop_t";
  explicit EmergencyStopController(EmergencyStop& estop) : estop_(estop) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  EmergencyStop& estop_;
};

}  // namespace devices
