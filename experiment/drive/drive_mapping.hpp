// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiment/drive/drive_profile.hpp"
#include "shoal/sim_vehicle_t.hpp"
#include "sim/bus/bus.hpp"

namespace experiment {

/// Device of a vehicle.
struct DrivenDevice {
  std::string name, type;
  std::string channel;        ///< of its commands; empty: it takes none
  std::string command_types;  ///< comma separated
};

/// Vehicle as a driver sees it, with all its devices: programs that drive it are found by their sensors too.
struct DrivenVehicle {
  std::string name;
  std::vector<DrivenDevice> devices;
};

/// Returns the vehicle that a message of `sim.vehicle` describes.
DrivenVehicle driven_vehicle(const shoal::sim_vehicle_t& message);

/// Where a vehicle is, for commands relative to it.
struct DrivePose {
  double yaw_rad = 0;  ///< in the world frame
  double depth_m = 0;  ///< below the still surface
};

/// Command to publish.
struct DriveCommand {
  std::string channel;
  sim::Bytes payload;
};

/// Returns the kinds by which a vehicle can be driven, the most fitting first; empty: none.
std::vector<DriveKind> drive_kinds(const DriveProfile& profile, const DrivenVehicle& vehicle);

/// Commands of one vehicle for positions of a driver's controls.  All zero is the safe command: the vehicle stops, or
/// its joints do.
class DriveMapping {
 public:
  /// `kind`: none for the most fitting.  Throws DriveError if the vehicle cannot be driven so.
  DriveMapping(const DriveProfile& profile, const DrivenVehicle& vehicle, std::optional<DriveKind> kind);

  DriveKind kind() const { return kind_; }
  /// Returns the names of its axes; of kind joints, the devices.
  const std::vector<std::string>& axes() const { return axes_; }
  /// Returns the commands for positions of the axes, each clamped to -1 to 1; what is not named is 0.  `utime`: stamp.
  std::vector<DriveCommand> commands(const DriveValues& values, std::int64_t utime,
                                     const std::optional<DrivePose>& pose);

 private:
  friend std::vector<DriveKind> drive_kinds(const DriveProfile& profile, const DrivenVehicle& vehicle);

  /// How a device is commanded.
  enum class Form {
    twist,
    tilt,
    ackermann,
    helm,
    thrust_rudder_elevator,
    thrust_rudder,
    pan_tilt_zoom,
    joint_servo,
    joint,
    joint_settings
  };
  struct Target {
    Form form;
    std::string channel;
    std::string axis = {};  ///< of a joint: the device
  };
  /// Actuator without a drive.
  struct MixTarget {
    std::string channel;
    bool wrench = false;
    std::vector<DriveProfile::Share> shares;
  };

  explicit DriveMapping(const DriveProfile& profile) : profile_(profile) {}
  /// Finds the devices of a kind; returns false if there are none.
  bool find(DriveKind kind, const DrivenVehicle& vehicle);
  void find_twist(const DrivenVehicle& vehicle);
  void find_program(bool tilts, const DrivenVehicle& vehicle);
  void find_helm(const DrivenVehicle& vehicle);
  void find_thrust(const DrivenVehicle& vehicle);
  void find_cameras(const DrivenVehicle& vehicle);
  void find_joints(const DrivenVehicle& vehicle);
  bool add_craft(const DriveProfile::Craft& craft, const DrivenVehicle& vehicle);
  sim::Bytes payload(const Target& target, const DriveValues& values, std::int64_t utime,
                     const std::optional<DrivePose>& pose);
  sim::Bytes helm_payload(const DriveValues& values, std::int64_t utime, const std::optional<DrivePose>& pose);

  DriveProfile profile_;
  DriveKind kind_ = DriveKind::twist;
  std::vector<std::string> axes_;
  std::vector<Target> targets_;
  std::vector<MixTarget> mix_;
  bool turned_ = false, dived_ = false;  // the last helm command had a set point ahead
};

}  // namespace experiment
