// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/coop_craft.hpp"

#include <cmath>
#include <numbers>

namespace autonomy {

CoopCraft::CoopCraft(const Params& params, std::unique_ptr<HelmBehavior> behavior)
    : params_(params), behavior_(std::move(behavior)), access_(params.access, params.name) {}

void CoopCraft::receive(const shoal::gps_data_t& fix) {
  utime_ = fix.utime;  // the time stamp is used with or without a fix: a clock may be set back
  const Vector2d p_W(fix.xyz_pos[0], fix.xyz_pos[1]);
  if (fix.gps_lock < 1 || !p_W.allFinite() || !(fix.horizontal_accuracy > 0)) return;
  Motion motion{fix.utime, p_W, Vector2d::Zero()};
  // GPS gives the course clockwise from north.
  if (std::isfinite(fix.speed) && std::isfinite(fix.heading))
    motion.v_W = turned({fix.speed, 0}, 0.5 * std::numbers::pi - fix.heading);
  motion_ = motion;
  steps_since_fix_ = 0;
  position_std_m_ = fix.horizontal_accuracy;
}

void CoopCraft::receive(const shoal::acoustic_received_t& packet) {
  const auto state = state_in(packet);
  if (!state) {
    ++(order_in(packet) ? counts_.orders : counts_.bad_frames);
    return;
  }
  ++counts_.received;
  if (direct_.is_direct(packet, *state))
    behavior_->receive_state(packet.source, motion_of(*state));
  else
    ++counts_.relayed;
}

void CoopCraft::receive(const shoal::ins_t& attitude) {
  attitude_.receive(attitude.utime, attitude);
}

Motion CoopCraft::motion_at(std::int64_t utime) const {
  Motion motion = *motion_;
  motion.p_W += motion.v_W * seconds(utime - motion.utime);
  motion.utime = utime;
  if (attitude_.is_known() && !attitude_.is_lost(utime)) motion.yaw_rad = attitude_.yaw_rad();
  return motion;
}

void CoopCraft::receive(const shoal::planar_lidar_t& scan) {
  if (!motion_ || std::abs(seconds(scan.utime - motion_->utime)) > params_.oldest_fix_s) return;
  behavior_->receive_scan({scan.ranges, scan.rad0, scan.radstep}, motion_at(scan.utime));
}

CoopCraft::Decision CoopCraft::step() {
  Decision decision;
  shoal::helm_command_t helm{utime_, 0, unknown, unknown, unknown};
  // The time is that of GPS: without its messages only the calls of this function are counted.
  const bool is_recent = steps_since_fix_++ * params_.period_s <= params_.oldest_fix_s;
  const bool has_fix = is_recent && motion_ && std::abs(seconds(utime_ - motion_->utime)) <= params_.oldest_fix_s;
  if (!motion_) return decision;
  decision.remark = remark();
  if (has_fix) {
    const Course course = behavior_->steer(motion_at(motion_->utime));
    helm.speed_mps = course.speed_mps;
    helm.heading_rad = course.heading_rad;
    decision.estimate = estimate();
    if (access_.take_turn(utime_)) decision.send = state_frame(*decision.estimate);
  }
  decision.helm = helm;  // without a fix it stops
  return decision;
}

/// Reports once that it has been waiting for a long time.
std::string CoopCraft::remark() {
  if (!patient_since_ || utime_ < *patient_since_) patient_since_ = utime_;
  const double waited_s = seconds(utime_ - *patient_since_);
  const std::string text = behavior_->remark();
  if (remarked_ || text.empty() || waited_s < params_.timeout_s) return {};
  remarked_ = true;
  return "after " + std::to_string(std::llround(waited_s)) + " s: " + text;
}

shoal::estimate_t CoopCraft::estimate() const {
  const Eigen::Matrix2d P = squared(position_std_m_) * Eigen::Matrix2d::Identity();
  shoal::estimate_t estimate = estimate_message(motion_->utime, motion_->p_W, motion_->v_W, P);
  estimate.covariance_m2[8] = 1;  // it floats; waves and tide are unknown
  estimate.yaw_rad = std::atan2(motion_->v_W.y(), motion_->v_W.x());
  estimate.clock_error_s = 0;  // GPS sets the clock
  return estimate;
}

std::optional<shoal::modem_send_t> CoopCraft::state_frame(const shoal::estimate_t& estimate) {
  AcousticState state = state_of(estimate, params_.id);
  state.depth_m = params_.transducer_depth_m;
  auto message = to_everybody(state);
  if (message) ++counts_.sent;
  return message;
}

}  // namespace autonomy
