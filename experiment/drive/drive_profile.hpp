// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace experiment {

/// Ways of driving a vehicle.
enum class DriveKind {
  twist,   ///< velocity and turn rate of a drive
  tilt,    ///< tilt and turn rate of a vehicle that balances
  helm,    ///< speed, heading and depth of an autopilot
  thrust,  ///< thrust, rudder and elevator, or single thrusters and fins
  camera,  ///< pan, tilt and zoom of a camera
  joints   ///< velocities of joints
};

inline constexpr sim::ChoiceWords<DriveKind> drive_kind_words{
    {"twist", DriveKind::twist},   {"tilt", DriveKind::tilt},     {"helm", DriveKind::helm},
    {"thrust", DriveKind::thrust}, {"camera", DriveKind::camera}, {"joints", DriveKind::joints}};

/// Axis of a driver's controls, -1 to 1.  Positive: ahead, to the left (counter-clockwise), down, sideways to the left.
enum class DriveAxis { forward, turn, dive, side };

inline constexpr sim::ChoiceWords<DriveAxis> drive_axis_words{
    {"forward", DriveAxis::forward}, {"turn", DriveAxis::turn}, {"dive", DriveAxis::dive}, {"side", DriveAxis::side}};

/// Positions of the axes, by name; of the joints, by device.
using DriveValues = std::map<std::string, double, std::less<>>;

/// Keys, buttons, axes, limits and rates of manual driving.
struct DriveProfile {
  /// Key of the terminal that moves the set position of an axis.
  struct Key {
    std::string key;  ///< one character, or up, down, left, right
    DriveAxis axis = DriveAxis::forward;
    double step = 0.25;
    void read(sim::ParamReader& in);
  };
  struct Keys {
    std::string hold = "space";    ///< dead-man key
    std::string centre = "x";      ///< sets all axes to 0
    std::string next_joint = "n";  ///< the next joint
    std::vector<Key> steps;
    void read(sim::ParamReader& in);
  };
  /// Axis of a gamepad.
  struct PadAxis {
    int code = 0;
    DriveAxis axis = DriveAxis::forward;
    double scale = 1;
    double low = -32768, high = 32767;  ///< where the device does not say
    void read(sim::ParamReader& in);
  };
  struct Gamepad {
    int hold = 310;        ///< code of the dead-man button; BTN_TL
    int next_joint = 311;  ///< BTN_TR
    double dead_band = 0.1;
    std::vector<PadAxis> axes;
    void read(sim::ParamReader& in);
  };
  struct Twist {
    double forward_mps = 1, turn_radps = 1, steering_rad = 0.5;
    void read(sim::ParamReader& in);
  };
  struct Tilt {
    double tilt_rad = sim::degrees_to_radians(4), turn_radps = 1;
    void read(sim::ParamReader& in);
  };
  struct Helm {
    double speed_mps = 1.5, heading_lead_rad = sim::degrees_to_radians(45), depth_lead_m = 2;
    void read(sim::ParamReader& in);
  };
  struct Thrust {
    double thrust = 1, rudder = 1, elevator = 1;
    void read(sim::ParamReader& in);
  };
  struct Camera {
    double pan_radps = sim::degrees_to_radians(60), tilt_radps = sim::degrees_to_radians(40);
    double zoom_radps = sim::degrees_to_radians(15);
    void read(sim::ParamReader& in);
  };
  struct Joints {
    double velocity = 0.5;
    void read(sim::ParamReader& in);
  };
  /// Component of a command.
  enum class Part { value, force_x_N, force_y_N, force_z_N, torque_x_Nm, torque_y_Nm, torque_z_Nm };
  /// Share of a device in the axes: value = sum of axis times gain.
  struct Share {
    std::string device;
    Part part = Part::value;
    double forward = 0, turn = 0, dive = 0, side = 0;
    void read(sim::ParamReader& in);
  };
  /// Shares of the thrusters, fins and other actuators of one craft.
  struct Craft {
    std::string name;
    std::vector<Share> shares;
    void read(sim::ParamReader& in);
  };
  /// Program that drives a vehicle with certain devices, and takes shoal.twist_command_t on VEHICLE.NAME.cmd.
  struct Program {
    std::string name;
    std::vector<std::string> devices;
    bool tilts = false;  ///< takes shoal.inclination_t too: its tilt from the balance
    void read(sim::ParamReader& in);
  };

  double rate_hz = 20;
  double hold_s = 0.2;
  Keys keys;
  Gamepad gamepad;
  Twist twist;
  Tilt tilt;
  Helm helm;
  Thrust thrust;
  Camera camera;
  Joints joints;
  std::vector<Craft> crafts;
  std::vector<Program> programs;

  void read(sim::ParamReader& in);
};

inline constexpr sim::ChoiceWords<DriveProfile::Part> drive_part_words{
    {"value", DriveProfile::Part::value},
    {"force_x_N", DriveProfile::Part::force_x_N},
    {"force_y_N", DriveProfile::Part::force_y_N},
    {"force_z_N", DriveProfile::Part::force_z_N},
    {"torque_x_Nm", DriveProfile::Part::torque_x_Nm},
    {"torque_y_Nm", DriveProfile::Part::torque_y_Nm},
    {"torque_z_Nm", DriveProfile::Part::torque_z_Nm}};

/// Returns the text of the profile that the program has.
std::string_view default_drive_profile();
/// Reads a profile; empty: the one of the program.  Throws sim::ConfigError with the place of each mistake.
DriveProfile read_drive_profile(const std::string& file);
/// Reads the text of a profile.  Throws sim::ConfigError.
DriveProfile parse_drive_profile(const std::string& text, const std::string& name);

/// Error of a vehicle that cannot be driven as asked, or of a gamepad.
class DriveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace experiment
