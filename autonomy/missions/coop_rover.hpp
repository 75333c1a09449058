// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "autonomy/acomms/position_reports.hpp"
#include "autonomy/behaviors/avoid_behavior.hpp"
#include "autonomy/behaviors/obstacle_avoidance.hpp"
#include "autonomy/behaviors/waypoint_follower.hpp"
#include "autonomy/filters/ekf.hpp"
#include "autonomy/filters/odometer.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/swarm_position_t.hpp"

namespace autonomy {

/// Autonomy of one rover of the cooperative experiment.  A rover with GPS reports its position to the others; a rover
/// without GPS localizes itself by odometry and detections of those that report.  A pure function of the messages in
/// their order, independent of clock and bus.
class CoopRover {
 public:
  struct Params {
    std::string name;
    Pose2 start;
    std::vector<Vector2d> waypoints_W;
    double speed_mps = 0.8;
    double start_position_std_m = 0.1;
    double start_yaw_std_rad = 0.03;
    double seen_std_m = 0.15;  ///< of each coordinate of a detection
    double report_period_s = 1.0;
    std::optional<Avoidance> avoidance;  ///< unset: ObstacleAvoidance
  };
  struct Outgoing {
    std::string channel;
    std::vector<std::byte> payload;
  };

  /// Throws std::invalid_argument without waypoints.
  explicit CoopRover(const Params& params);

  /// Devices whose reports it subscribes to, on NAME.DEVICE.
  static std::span<const std::string_view> devices();
  /// Processes a report of one of those.  Throws shoal::MessageError on invalid bytes.
  void receive(std::string_view device, std::span<const std::byte> payload);
  /// Computes the messages to publish after all reports up to `utime`.
  std::vector<Outgoing> step(std::int64_t utime);

  const Ekf& filter() const { return filter_; }
  const WaypointFollower& follower() const { return follower_; }

 private:
  void receive_odometry(std::span<const std::byte> payload);
  void receive_gps(const shoal::gps_data_t& fix);
  void receive_sightings(const shoal::swarm_position_t& seen);
  void receive_scan(std::span<const std::byte> payload);
  /// Returns distance and rotation from the last odometry to `utime`.
  Increment since_odometry(std::int64_t utime) const;

  Twist drive(std::int64_t utime);
  Twist drive_by_helm(std::int64_t utime);
  Motion motion_at(std::int64_t utime) const;
  bool report_is_due(std::int64_t utime) const;
  std::vector<std::byte> report() const;
  std::vector<std::byte> pose_message(const Pose2& pose) const;
  std::string channel(std::string_view name) const { return params_.name + "." + std::string(name); }

  Params params_;
  Odometer odometer_;
  Ekf filter_;
  WaypointFollower follower_;
  ObstacleAvoidance avoidance_;
  PositionReports reports_;

  std::optional<std::int64_t> odometry_utime_;
  Twist measured_;
  std::optional<double> gps_std_m_;
  std::optional<std::int64_t> reported_utime_;
  std::int64_t scan_utime_ = 0;
  Scan scan_;
};

}  // namespace autonomy
