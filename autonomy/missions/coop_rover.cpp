// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/coop_rover.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "shoal/message_codec.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/base/math.hpp"

namespace autonomy {

namespace {

using Payload = std::span<const std::byte>;

/// Maximum age of a scan.
constexpr double oldest_scan_s = 0.5;

ObstacleAvoidance::Params avoidance_params(const CoopRover::Params& params) {
  ObstacleAvoidance::Params avoidance;
  avoidance.speed_mps = params.speed_mps;
  return avoidance;
}

}  // namespace

CoopRover::CoopRover(const Params& params)
    : params_(params),
      odometer_(params.start),
      filter_(params.start, params.start_position_std_m, params.start_yaw_std_rad),
      follower_(params.waypoints_W),
      avoidance_(avoidance_params(params)) {}

std::span<const std::string_view> CoopRover::devices() {
  static constexpr std::array<std::string_view, 5> names = {"odometry", "gps", "swarm_position", "lidar", "modem"};
  return names;
}

void CoopRover::receive(std::string_view device, Payload payload) {
  using shoal::Finite;
  if (device == "odometry") receive_odometry(payload);
  // Without a fix the values are NaN, and so are absolute positions that a swarm sensor does not measure.
  if (device == "gps") receive_gps(shoal::decode<shoal::gps_data_t>(payload, Finite::any));
  if (device == "swarm_position") receive_sightings(shoal::decode<shoal::swarm_position_t>(payload, Finite::any));
  if (device == "lidar") receive_scan(payload);
  if (device == "modem") reports_.receive(shoal::decode<shoal::modem_received_t>(payload, Finite::required));
}

void CoopRover::receive_odometry(Payload payload) {
  const auto odometry = shoal::decode<shoal::odometry_t>(payload, shoal::Finite::required);
  filter_.predict(odometer_.update({odometry.x_m, odometry.y_m}, odometry.theta_rad));
  measured_ = {odometry.forward_mps, odometry.turn_radps};
  odometry_utime_ = odometry.utime;
}

Increment CoopRover::since_odometry(std::int64_t utime) const {
  if (!odometry_utime_) return {};
  const double dt_s = seconds(utime - *odometry_utime_);
  return {measured_.forward_mps * dt_s, 0, measured_.turn_radps * dt_s};
}

void CoopRover::receive_gps(const shoal::gps_data_t& fix) {
  const Vector2d p_W(fix.xyz_pos[0], fix.xyz_pos[1]);
  if (fix.gps_lock < 1 || !p_W.allFinite() || !(fix.horizontal_accuracy > 0)) return;
  // The filter is at the time of the last odometry; the fix is shifted to that time.
  const Vector2d moved_W = turned({since_odometry(fix.utime).forward_m, 0}, filter_.pose().yaw_rad);
  filter_.update_position(p_W - moved_W, fix.horizontal_accuracy);
  gps_std_m_ = fix.horizontal_accuracy;
}

void CoopRover::receive_sightings(const shoal::swarm_position_t& seen) {
  const Increment moved = since_odometry(seen.utime);
  for (std::size_t i = 0; i < seen.vehicle.size(); ++i) {
    const Vector2d seen_B(seen.relative_m[i][0], seen.relative_m[i][1]);
    if (!seen_B.allFinite()) continue;
    const auto neighbor = reports_.take(seen.vehicle[i], seen.utime);
    if (!neighbor) continue;
    // As seen at the last odometry: at 20 m a rotation of 3 degrees in the meantime is a meter.
    const Vector2d p_BN_B = turned(seen_B, moved.turn_rad) + Vector2d(moved.forward_m, 0);
    filter_.update_relative(p_BN_B, params_.seen_std_m, neighbor->p_W, neighbor->std_m);
  }
}

void CoopRover::receive_scan(Payload payload) {
  auto scan = shoal::decode<shoal::planar_lidar_t>(payload, shoal::Finite::required);
  scan_ = {std::move(scan.ranges), scan.rad0, scan.radstep};
  scan_utime_ = scan.utime;
  if (params_.avoidance && odometry_utime_) params_.avoidance->receive(scan_, motion_at(scan.utime));
}

Motion CoopRover::motion_at(std::int64_t utime) const {
  const Increment moved = since_odometry(utime);
  Motion motion;
  motion.utime = utime;
  motion.yaw_rad = sim::wrap_angle(filter_.pose().yaw_rad + moved.turn_rad);
  motion.p_W = filter_.pose().p_W + turned({moved.forward_m, 0}, filter_.pose().yaw_rad);
  motion.v_W = turned({measured_.forward_mps, 0}, motion.yaw_rad);
  return motion;
}

Twist CoopRover::drive_by_helm(std::int64_t utime) {
  const Vector2d goal_B = follower_.goal_B(filter_.pose(), seconds(utime));
  const Motion own = motion_at(utime);
  const double goal_rad = sim::wrap_angle(filter_.pose().yaw_rad + std::atan2(goal_B.y(), goal_B.x()));
  const Course course = params_.avoidance->steer(own, {params_.speed_mps, goal_rad, goal_B.norm()});
  const double error_rad = sim::wrap_angle(course.heading_rad - own.yaw_rad);
  // It turns on the spot to a course on the other side.
  return {course.speed_mps * std::max(0.0, std::cos(error_rad)), std::clamp(2 * error_rad, -1.0, 1.0)};
}

std::vector<CoopRover::Outgoing> CoopRover::step(std::int64_t utime) {
  std::vector<Outgoing> out;
  const Twist twist = drive(utime);
  shoal::twist_command_t command{};
  command.utime = utime;
  command.forward_mps = twist.forward_mps;
  command.turn_radps = twist.turn_radps;
  out.push_back({channel("drive.cmd"), shoal::encode(command)});
  if (!odometry_utime_) return out;
  out.push_back({channel("estimate"), pose_message(filter_.pose())});
  out.push_back({channel("odometry_only"), pose_message(odometer_.pose())});
  if (report_is_due(utime)) {
    out.push_back({channel("modem.cmd"), report()});
    reported_utime_ = utime;
  }
  return out;
}

Twist CoopRover::drive(std::int64_t utime) {
  // Without a scan it stops.
  if (scan_.ranges_m.empty() || seconds(utime - scan_utime_) > oldest_scan_s) return {};
  if (params_.avoidance) return odometry_utime_ ? drive_by_helm(utime) : Twist{};
  return avoidance_.steer(follower_.goal_B(filter_.pose(), seconds(utime)), scan_);
}

bool CoopRover::report_is_due(std::int64_t utime) const {
  // A rover without GPS does not report: its position depends on the others.
  if (!gps_std_m_) return false;
  return !reported_utime_ || seconds(utime - *reported_utime_) >= params_.report_period_s - 1e-9;
}

std::vector<std::byte> CoopRover::report() const {
  const Pose2& pose = filter_.pose();
  const Vector2d v_W = turned({measured_.forward_mps, 0}, pose.yaw_rad);
  shoal::position_report_t report{};
  report.utime = *odometry_utime_;
  report.vehicle = params_.name;
  for (int i = 0; i < 2; ++i) {
    report.position_m[i] = pose.p_W[i];
    report.velocity_mps[i] = v_W[i];
  }
  // Errors of GPS drift slowly and do not average out, so the reported deviation has a lower bound.
  report.position_std_m = std::max(filter_.position_std_m(), *gps_std_m_);
  return shoal::encode(broadcast(report));
}

std::vector<std::byte> CoopRover::pose_message(const Pose2& pose) const {
  const Vector2d v_W = turned({measured_.forward_mps, 0}, pose.yaw_rad);
  shoal::pose_t message{};
  message.utime = *odometry_utime_;
  for (int i = 0; i < 2; ++i) {
    message.pos[i] = pose.p_W[i];
    message.vel[i] = v_W[i];
  }
  message.orientation[0] = std::cos(0.5 * pose.yaw_rad);
  message.orientation[3] = std::sin(0.5 * pose.yaw_rad);
  message.rotation_rate[2] = measured_.turn_radps;
  return shoal::encode(message);
}

}  // namespace autonomy
