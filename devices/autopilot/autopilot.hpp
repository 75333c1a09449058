// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "devices/autopilot/autopilot_actuators.hpp"
#include "devices/autopilot/autopilot_config.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace shoal {
class helm_command_t;
class station_command_t;
class waypoints_command_t;
}  // namespace shoal

namespace devices {

/// Autopilot of a marine vehicle: controls heading, depth or altitude and speed, follows waypoints, or keeps station.
/// Uses the true motion of the body it is mounted on, and publishes commands on the channels of its actuators at its
/// rate, as an external program would.
class Autopilot final : public sim::Sensor {
 public:
  static constexpr const char* meaning =
      "Autopilot: heading, depth, altitude, speed, waypoints, station keeping, by thrusters and fins of its vehicle.";
  static constexpr bool measures_alone = true;
  static constexpr double default_rate_hz = 10;
  static constexpr const char* example = "thrusters: [push]";
  using Params = AutopilotParams;
  using Mode = AutopilotMode;

  /// Setpoints and errors.  NaN: not applicable in the present mode.
  struct Reading {
    Mode mode = Mode::off;
    double speed_mps = 0, heading_rad = 0, depth_m = 0, altitude_m = 0;
    double speed_error_mps = 0, heading_error_rad = 0, depth_error_m = 0, altitude_error_m = 0;
    double cross_track_m = 0, distance_m = 0;
    bool saturated = false;
    void visit_state(sim::StateArchive& archive);
  };

  Autopilot(const Params& params, const sim::DeviceContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double, sim::Random&) override {}
  std::int64_t rays() const override { return altitude_desired_m_ || may_need_bottom_ ? 1 : 0; }
  /// Returns true when the configuration has an altitude to hold.
  bool needs_bottom() const override;
  std::string_view lacks() const override;
  std::vector<sim::PlannedPlace> planned_places() const override;
  void visit_state(sim::StateArchive& archive) override;
  const Reading& reading() const { return reading_; }
  const Route& route() const { return route_; }

  // Commands.  NaN keeps the present value of a field.
  /// Changes the mode.  Throws std::runtime_error for mode waypoints without a route.
  void set_mode(Mode mode);
  /// Sets heading, speed, depth or altitude.  A heading ends a route or station keeping.
  void set_helm(const shoal::helm_command_t& command);
  /// Starts a new route.
  void set_waypoints(const shoal::waypoints_command_t& command);
  /// Starts station keeping.
  void set_station(const shoal::station_command_t& command);

 private:
  CraftMotion motion_of(const sim::World& world) const;
  double altitude_of(const sim::SenseContext& context) const;
  double depth_m() const;
  Eigen::Vector2d place() const;
  void warn_of_no_speed(const sim::DeviceContext& context) const;
  /// Keeps a warning for the end of the run of a commanded depth at a place.
  void note_depth(const Eigen::Vector2d& p_W, double depth_m);
  void note_start_of_route();
  void take_height(const std::optional<double>& depth_m, const std::optional<double>& altitude_m);
  void start_route(std::vector<Waypoint> points, bool loop);
  void follow_route(double dt_s);
  void follow_circle();
  void start_circle(const Eigen::Vector2d& center_W);
  void take_waypoint();
  double height_desired(const sim::SenseContext& context);
  void drive(const sim::SenseContext& context, const Demand& demand);
  void drive_helm(const Demand& demand, sim::Time now);

  Params params_;
  const sim::World& world_;
  sim::Vehicle& vehicle_;
  const sim::Body& body_;
  const sim::DeviceFaults& faults_;
  sim::WorldWarnings& warnings_;
  const std::string who_;
  const bool may_need_bottom_;
  double surface_m_;  // height of the still water surface
  std::optional<AutopilotActuators> actuators_;
  HelmLaw law_;
  Route route_;
  Circle circle_;
  Mode mode_;
  Setpoint desired_;
  // Exactly one of the two is set.
  std::optional<double> depth_desired_m_, altitude_desired_m_;
  AutopilotActuators::Given given_;  // of the last step
  Reading reading_;
  std::unique_ptr<sim::OpenChannel> helm_channel_;  // opened by the first command
};

/// Receives shoal.helm_command_t, shoal.waypoints_command_t, shoal.station_command_t and shoal.autopilot_command_t.
class AutopilotController final : public sim::Controller {
 public:
  static constexpr const char* command_messages =
      "shoal.helm_command_t, shoal.waypoints_command_t, shoal.station_command_t, shoal.autopilot_command_t";
  explicit AutopilotController(Autopilot& autopilot) : autopilot_(autopilot) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  Autopilot& autopilot_;
};

}  // namespace devices
