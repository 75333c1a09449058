// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/joint/joint_servo.hpp"
#include "sim/vehicle/mounted_device.hpp"

namespace devices {

/// Joint servos of a vehicle, which another of its devices commands directly.
class ServoBank {
 public:
  /// `names`: devices or their aliases; empty: all joint servos of the vehicle, in its order.  Throws ConfigError at
  /// the place of the device when there is none of a name, or one is named twice.
  ServoBank(const sim::DeviceContext& context, const std::vector<std::string>& names);

  std::size_t size() const { return members_.size(); }
  /// Returns the number of the servo with this name or alias.
  std::optional<std::size_t> find(const std::string& name_or_alias) const;
  std::vector<std::string> names() const;

  /// Commands a position at the end of this step, rad or m.  Nothing happens while the servo takes no commands: it has
  /// no power or is stuck, or the emergency stop is engaged.
  void command(std::size_t i, double position, sim::Time now);
  /// Returns the present set point, and the position of the joint, rad or m.
  double set_point(std::size_t i);
  double position(std::size_t i);
  double low(std::size_t i);
  double high(std::size_t i);

 private:
  struct Member {
    std::string name, alias;
    sim::Acting* acting = nullptr;  ///< set at first use: devices of the vehicle are built one after the other
    JointServo* servo = nullptr;
  };
  Member& member(std::size_t i);

  const sim::Vehicle& vehicle_;
  std::vector<Member> members_;
};

/// Joint servo of a vehicle file.
struct ServoOfVehicle {
  std::string device;
  const JointServo::Params* params;
  double low, high;  ///< range of the servo within the stops of its axis, rad or m; may be infinite
  /// Returns whether this is its name or its alias.
  bool is_called(const std::string& name) const;
};
/// Returns the joint servos of a vehicle file, in its order.
std::vector<ServoOfVehicle> servos_of(const sim::VehicleConfig& vehicle);

}  // namespace devices
