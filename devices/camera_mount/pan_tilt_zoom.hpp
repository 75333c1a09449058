// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "devices/joint/set_point.hpp"
#include "devices/motion/servo_bank.hpp"
#include "devices/ranging/camera.hpp"
#include "sim/camera/optics.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Mount of a camera: two servos that pan and tilt it, and its field of view.
///
/// Each axis has a set point that moves to a target at a limited speed, or at a velocity to the end of its range.  The
/// servos follow their set points with their own limits of speed, acceleration and effort; the lens follows at once. An
/// axis that has arrived leaves its servo to other devices.
class PanTiltZoom final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Mount that pans and tilts a camera by two servos, and zooms.";
  static constexpr double default_rate_hz = 10;
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr const char* fixed_keys[] = {"pan", "tilt", "camera"};
  static constexpr const char* example = "pan: arm, camera: eye, min_fov_deg: 10";
  /// The axes in the order of messages.
  enum Axis : std::size_t { pan, tilt, zoom };
  static constexpr std::size_t axes = 3;
  struct Params {
    std::string pan, tilt;  ///< servos; empty: none
    std::string camera;     ///< empty: none
    double pan_speed_radps = sim::degrees_to_radians(360);
    double tilt_speed_radps = sim::degrees_to_radians(360);
    double zoom_speed_radps = sim::degrees_to_radians(30);
    double min_fov_rad = sim::degrees_to_radians(5);
    std::optional<double> max_fov_deg;  ///< unset: that of the camera
    sim::NoiseParams angle_noise;       ///< of pan and tilt, rad
    void read(sim::ParamReader& in);
  };
  /// Command of an axis.  NaN: none.
  struct Command {
    double position = std::numeric_limits<double>::quiet_NaN();
    double velocity = std::numeric_limits<double>::quiet_NaN();  ///< with a position: the largest speed
  };

  PanTiltZoom(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  auto noises() { return std::tie(noise_); }
  /// Throws std::runtime_error when the field of view does not fit the camera.
  void change(const Params& params);
  void visit_state(sim::StateArchive& archive) override;

  /// Commands the axes.  Throws std::runtime_error, and changes nothing, for an infinite value, a negative largest
  /// speed, and a motion of an axis that the device does not have.
  void command(const std::array<Command, axes>& commands);
  /// Reading of the last sample; NaN: there is no such axis.
  double position(Axis axis) const { return positions_[axis]; }
  double velocity(Axis axis) const { return velocities_[axis]; }

 private:
  enum class Mode { free, position, velocity };
  struct Motion {
    Mode mode = Mode::free;
    double target = 0;  ///< position or velocity
    double speed = 0;   ///< largest, to a position
    SetPoint set_point;
    void visit_state(sim::StateArchive& archive) {
      archive(mode, target, set_point);
      archive.not_only_finite(speed);
    }
  };
  /// Servo of an axis, and the axis of its joint.
  struct Turning {
    std::size_t servo;
    const sim::Joint* joint;
    int axis;
    double max_velocity_radps;  ///< of the servo
  };

  ServoOfVehicle find_servo(const sim::DeviceContext& context, const char* key, const std::string& name) const;
  void find_camera(const sim::DeviceContext& context);
  void find_range(const Params& params);
  bool has(Axis axis) const { return axis == zoom ? !params_.camera.empty() : turning_[axis].has_value(); }
  double low(Axis axis);
  double high(Axis axis);
  double max_speed(Axis axis) const;
  void move(Axis axis, const sim::ActContext& context);
  void set_lens();

  Params params_;
  const sim::Vehicle& vehicle_;
  std::optional<ServoBank> servos_;
  std::array<std::optional<Turning>, 2> turning_;
  std::optional<sim::OpticsConfig> optics_;  ///< of the camera, as in the vehicle file
  Camera* camera_ = nullptr;                 ///< set at first use: devices of the vehicle are built one after the other
  double min_fov_rad_ = 0, max_fov_rad_ = 0;
  sim::NoiseOf<&Params::angle_noise> noise_;
  std::array<Motion, axes> motions_;
  std::array<double, axes> positions_, velocities_;
};

/// Receives shoal.pan_tilt_zoom_command_t.
class PanTiltZoomController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.pan_tilt_zoom_command_t";
  explicit PanTiltZoomController(PanTiltZoom& mount) : mount_(mount) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  PanTiltZoom& mount_;
};

}  // namespace devices
