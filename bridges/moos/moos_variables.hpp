// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bridges/moos/moos_session.hpp"
#include "bridges/moos/vehicle_commands.hpp"
#include "bridges/moos/vehicle_navigation.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/planar_lidar_t.hpp"

namespace bridges {

// The table of variables and channels: docs/guides/attach_moos.md.

/// Returns NAV_X, NAV_HEADING ... of these fields; those without a value are left out.
std::vector<MoosValue> nav_values(const VehicleNavigation& navigation, VehicleNavigation::Fields fields);

/// What a node report says of the vehicle beside its navigation.
struct MoosNode {
  std::string name, type = "usv";
  double length_m = 2;
};
/// Returns NODE_REPORT_LOCAL; an empty value while position or heading are unknown.  `moos_time_s`: wall time times
/// warp.
std::vector<MoosValue> node_report(const MoosNode& node, const VehicleNavigation& navigation, double moos_time_s);

/// Returns LASERRANGE: the ranges of a scan in meters, from the right to the left as the angles, in degrees.
MoosValue laser_value(const shoal::planar_lidar_t& scan);
/// Returns ODOMETRY: X forward and Y left of the start in meters, O counter-clockwise in radians.
MoosValue odometry_value(const shoal::odometry_t& odometry);
/// Returns NODE_MESSAGE for bytes that another vehicle sent as NODE_MESSAGE_LOCAL, else SHOAL_MODEM_RECEIVED.
MoosValue modem_value(const shoal::modem_received_t& received);

/// Commands of the community to the vehicle.
class MoosCommands {
 public:
  enum class Control {
    none,
    helm,       ///< DESIRED_HEADING, DESIRED_SPEED, DESIRED_DEPTH to an autopilot
    actuators,  ///< DESIRED_RUDDER, DESIRED_THRUST, DESIRED_ELEVATOR, in percent
  };
  struct Options {
    Control control = Control::helm;
    std::string autopilot, drive, modem;  ///< channels of commands
    ThrusterPair thrusters;               ///< of the actuators, instead of the drive
  };
  /// Modem messages of one reading of the connection; further ones are refused.
  static constexpr std::size_t max_modem_messages = 64;

  explicit MoosCommands(Options options) : options_(std::move(options)) {}

  /// Variables to subscribe to.
  std::vector<std::string> variables() const;
  /// Takes the new value of a variable; others are ignored.
  void take(const MoosMessage& message);
  /// Returns the commands since the last call: the last set points together, and each message to a modem.
  std::vector<ChannelPayload> take_commands(std::int64_t utime);
  /// Values that were refused: no finite number, or no message to a modem.
  std::uint64_t refused() const { return refused_; }

 private:
  struct ModemMessage {
    std::string destination, bytes;
  };
  bool take_set_point(const MoosMessage& message);
  void take_modem_message(const MoosMessage& message);
  std::vector<ChannelPayload> actuator_commands(std::int64_t utime) const;

  const Options options_;
  HelmSetPoints helm_;
  double rudder_percent_ = 0, thrust_percent_ = 0, elevator_percent_ = 0;
  bool changed_ = false;
  std::vector<ModemMessage> modem_messages_;
  std::uint64_t refused_ = 0;
};

}  // namespace bridges
