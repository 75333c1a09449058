// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/ranger.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "autonomy/acomms/state_packet.hpp"
#include "sim/base/math.hpp"

namespace autonomy {

namespace {

/// Silence of the IMU after which the heading is lost.
constexpr double oldest_imu_s = 1;
/// Time constant of the speed after a command.
constexpr double speed_time_s = 4;
/// Rate at which the accelerometers level the attitude.
constexpr double level_per_s = 0.05;
/// Below this speed over ground a fix has no course.
constexpr double course_min_mps = 0.5;
/// Angle between course and heading at the first fix: a current, and a turn in progress.
constexpr double first_heading_std_rad = 0.3;
/// Beams keep this distance from the surface and the bottom: their width, and the error of the pitch.
constexpr double beam_margin_m = 0.5;
/// Between the surface and the depth of the dive the current changes; the propeller also drives the vehicle a little
/// slower at the surface, which looks like a current.
constexpr double dive_current_std_mps = 0.1;
/// Beams used of a ping; their errors by the pose are the same, so that all of them would add little.
constexpr int beams_of_ping = 9;

RouteBehavior route_of(const std::vector<Vector2d>& points_W, double speed_mps, double reached_m) {
  RouteBehavior::Params params;
  params.speed_mps = speed_mps;
  params.lookahead_m = 12;
  params.reached_m = reached_m;
  return RouteBehavior(points_W, params);
}

}  // namespace

Ranger::Ranger(const Params& params)
    : params_(params),
      surface_(route_of(params.surface_W, params.speed_mps, 4)),
      dive_(route_of(params.dive_W, params.speed_mps, 0.5)),
      rise_(route_of(params.rise_W, params.speed_mps, 4)),
      access_(params.access, params.name) {}

double Ranger::gyro_yaw_rad() const {
  return sim::yaw_of(q_GB_->toRotationMatrix());
}

void Ranger::receive(const shoal::imu_t& imu) {
  utime_ = std::max(utime_, imu.utime);
  const Eigen::Vector3d w_B(imu.angular_velocity_radps[0], imu.angular_velocity_radps[1],
                            imu.angular_velocity_radps[2]);
  const Eigen::Vector3d f_B(imu.linear_acceleration_mps2[0], imu.linear_acceleration_mps2[1],
                            imu.linear_acceleration_mps2[2]);
  if (!w_B.allFinite() || !f_B.allFinite()) return;
  const double dt_s = imu_utime_ ? seconds(imu.utime - *imu_utime_) : 0;
  imu_utime_ = imu.utime;
  // After a gap the heading is unknown.
  if (dt_s > oldest_imu_s || dt_s < 0) {
    phase_ = Phase::lost;
    return;
  }
  if (!q_GB_) {
    q_GB_ = sim::rotation_between(f_B, Eigen::Vector3d::UnitZ());
    return;
  }
  const double angle_rad = w_B.norm() * dt_s;
  if (angle_rad > 0) *q_GB_ = *q_GB_ * Eigen::AngleAxisd(angle_rad, w_B.normalized());
  // Level: the measured specific force turns slowly towards the vertical, about a horizontal axis.
  const Eigen::Vector3d up_G = (*q_GB_ * f_B).normalized();
  const Eigen::Vector3d axis_G = up_G.cross(Eigen::Vector3d::UnitZ());
  const double off_rad = axis_G.norm();
  if (off_rad > 0) *q_GB_ = Eigen::AngleAxisd(level_per_s * dt_s * off_rad, axis_G / off_rad) * *q_GB_;
  q_GB_->normalize();
  turn_radps_ = (*q_GB_ * w_B).z();
  predict(imu.utime);
}

void Ranger::predict(std::int64_t utime) {
  const double dt_s = predicted_utime_ ? seconds(utime - *predicted_utime_) : 0;
  predicted_utime_ = utime;
  speed_mps_ += (commanded_mps_ - speed_mps_) * std::min(1.0, dt_s / speed_time_s);
  if (!filter_ || !q_GB_) return;
  const Eigen::Vector3d bow_G = *q_GB_ * Eigen::Vector3d::UnitX();
  filter_->predict(dt_s, gyro_yaw_rad(), speed_mps_ * bow_G.head<2>().norm(), -params_.pivot_m * turn_radps_);
}

void Ranger::start(const shoal::gps_data_t& fix, const Vector2d& p_W) {
  if (!q_GB_ || !(fix.speed > course_min_mps) || !std::isfinite(fix.heading)) return;
  const double course_rad = 0.5 * std::numbers::pi - fix.heading;
  filter_.emplace(p_W, fix.horizontal_accuracy, sim::wrap_angle(course_rad - gyro_yaw_rad()), first_heading_std_rad,
                  params_.filter);
}

void Ranger::receive(const shoal::gps_data_t& fix) {
  utime_ = std::max(utime_, fix.utime);
  const Vector2d p_W(fix.xyz_pos[0], fix.xyz_pos[1]);
  if (fix.gps_lock < 1 || !p_W.allFinite() || !(fix.horizontal_accuracy > 0)) return;
  last_fix_utime_ = fix.utime;
  ++counts_.fixes;
  if (!filter_) {
    start(fix, p_W);
    return;
  }
  if (phase_ == Phase::rising && !before_last_fix_) {
    before_last_fix_ = estimate();
    counts_.last_fix_m = (p_W - filter_->p_W()).norm();
  }
  filter_->update_position(p_W, fix.horizontal_accuracy);
}

void Ranger::receive(const shoal::pressure_t& pressure) {
  utime_ = std::max(utime_, pressure.utime);
  if (std::isfinite(pressure.depth_m)) depth_m_ = pressure.depth_m;
}

void Ranger::receive(const shoal::sonar_range_t& altitude) {
  utime_ = std::max(utime_, altitude.utime);
  altitude_m_.reset();
  if (altitude.valid != 0) altitude_m_ = altitude.range_m;
}

void Ranger::receive(const shoal::multibeam_t& ping) {
  utime_ = std::max(utime_, ping.utime);
  if (!filter_ || !q_GB_ || phase_ == Phase::lost) return;
  const Eigen::Matrix3d R_GB = q_GB_->toRotationMatrix();
  const int step = std::max(1, (ping.count - 1) / (beams_of_ping - 1));
  for (int i = 0; i < ping.count; i += step) {
    const auto beam = static_cast<std::size_t>(i);
    const double range_m = ping.ranges_m[beam];
    if (ping.valid[beam] == 0 || range_m > params_.range_max_m) continue;
    // The walls are vertical: only the horizontal part of the beam counts.  A beam that comes near the surface or the
    // bottom may have its echo from there.
    const double angle_rad = ping.angles_rad[beam];
    const Eigen::Vector3d beam_G = R_GB * Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0);
    const double up_m = range_m * beam_G.z();
    const double room_up_m = depth_m_ - beam_margin_m;
    const double room_down_m = altitude_m_.value_or(0) - beam_margin_m;
    if (up_m > std::max(room_up_m, beam_margin_m) || -up_m > std::max(room_down_m, beam_margin_m)) continue;
    const double off_bow_rad = sim::wrap_angle(std::atan2(beam_G.y(), beam_G.x()) - gyro_yaw_rad());
    // Beams share the error of the pose that the filter does not model: each counts less.
    const bool used = filter_->update_range(params_.walls_W, gyro_yaw_rad(), off_bow_rad, params_.sonar_ahead_m,
                                            range_m * beam_G.head<2>().norm(),
                                            params_.range_std_m * std::sqrt(static_cast<double>(beams_of_ping)));
    ++(used ? counts_.ranges : counts_.refused);
  }
}

RouteBehavior* Ranger::route() {
  switch (phase_) {
    case Phase::at_surface:
      return &surface_;
    case Phase::dived:
      return &dive_;
    case Phase::rising:
      return &rise_;
    case Phase::waiting_for_fix:
    case Phase::done:
    case Phase::lost:
      break;
  }
  return nullptr;
}

void Ranger::update_phase() {
  const bool has_imu = imu_utime_ && seconds(utime_ - *imu_utime_) <= oldest_imu_s;
  if (filter_ && !has_imu) phase_ = Phase::lost;
  if (phase_ == Phase::waiting_for_fix && filter_) phase_ = Phase::at_surface;
  if (phase_ == Phase::at_surface && surface_.finished()) {
    phase_ = Phase::dived;
    filter_->loosen_current(dive_current_std_mps);
  }
  if (phase_ == Phase::dived && dive_.finished()) {
    phase_ = Phase::rising;
    filter_->loosen_current(dive_current_std_mps);
  }
  if (phase_ == Phase::rising && rise_.finished() && before_last_fix_) phase_ = Phase::done;
}

Ranger::Decision Ranger::step() {
  Decision decision;
  if (utime_ == 0) return decision;
  update_phase();
  decision.helm = helm();
  commanded_mps_ = decision.helm->speed_mps;
  if (before_last_fix_ && before_last_fix_->utime != 0) {
    decision.before_last_fix = before_last_fix_;
    before_last_fix_->utime = 0;  // published once
  }
  if (!filter_ || phase_ == Phase::lost || phase_ == Phase::done) return decision;
  decision.estimate = estimate();
  if (access_.take_turn(utime_)) decision.send = state_frame(*decision.estimate);
  return decision;
}

shoal::helm_command_t Ranger::helm() {
  shoal::helm_command_t helm{utime_, 0, unknown, 0, unknown};
  if (phase_ == Phase::waiting_for_fix) {
    // It needs way for the course of its first fix; without a fix it stays where it is.
    const bool has_fix = last_fix_utime_ && seconds(utime_ - *last_fix_utime_) < 3;
    helm.speed_mps = has_fix && q_GB_ ? params_.speed_mps : 0;
    return helm;
  }
  RouteBehavior* const path = route();
  if (path == nullptr || !filter_) return helm;
  const double yaw_rad = filter_->yaw_rad(gyro_yaw_rad());
  const Vector2d v_W = turned({speed_mps_, 0}, yaw_rad) + filter_->current_W();
  const Course course = path->steer({utime_, filter_->p_W(), v_W, yaw_rad});
  // Against the current across the course.
  const Vector2d across = turned(filter_->current_W(), -course.heading_rad);
  const double crab_rad = std::asin(std::clamp(across.y() / params_.speed_mps, -0.5, 0.5));
  // After its last point the rising vehicle continues, because it is driven up by its fins.
  helm.speed_mps = phase_ == Phase::rising ? params_.speed_mps : course.speed_mps;
  helm.heading_rad = sim::wrap_angle(course.heading_rad - crab_rad);
  if (phase_ == Phase::dived) {
    helm.depth_m = params_.depth_m;
    if (altitude_m_) helm.depth_m = std::min(params_.depth_m, depth_m_ + *altitude_m_ - params_.altitude_min_m);
  }
  return helm;
}

shoal::estimate_t Ranger::estimate() const {
  const double yaw_rad = filter_->yaw_rad(gyro_yaw_rad());
  const Vector2d v_W = turned({speed_mps_, 0}, yaw_rad) + filter_->current_W();
  shoal::estimate_t estimate =
      estimate_message(predicted_utime_.value_or(utime_), filter_->p_W(), v_W, filter_->position_covariance());
  set_depth(estimate, depth_m_);
  estimate.yaw_rad = yaw_rad;
  estimate.clock_error_s = unknown;
  return estimate;
}

std::optional<shoal::modem_send_t> Ranger::state_frame(const shoal::estimate_t& estimate) {
  AcousticState state = state_of(estimate, params_.id);
  state.utime = utime_;
  auto message = to_everybody(state);
  if (message) ++counts_.sent;
  return message;
}

}  // namespace autonomy
