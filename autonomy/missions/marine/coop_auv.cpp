// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/coop_auv.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/base/math.hpp"
namespace autonomy {

namespace {

// Noise of a velocity that is not over ground: a current is unknown, an old one has changed.
constexpr double through_water_mpsprtHz = 0.3;
constexpr double coasting_mpsprtHz = 0.5;
constexpr double pressure_std_m = 0.1;
/// A time stamp may be older or newer than the newest by these limits.
constexpr double late_s = 2;
constexpr double max_gap_s = 5;
/// Time without a velocity, after which it extrapolates the last one.
constexpr double coast_after_s = 1;
/// Time after which a silent AHRS, or all sources of heading, count as failed.
constexpr double oldest_attitude_s = 2;
/// Correlation time of the error of an unknown heading.
constexpr double lost_heading_s = 60;
/// Silence of all devices together, which is longer than their intervals.
constexpr double max_quiet_s = 1;
/// Returns the ranges of a ping; infinity without an echo.
std::vector<float> scan_of(const shoal::multibeam_t& ping) {
  std::vector<float> ranges_m = ping.ranges_m;
  for (std::size_t i = 0; i < ranges_m.size(); ++i)
    if (ping.valid[i] == 0) ranges_m[i] = std::numeric_limits<float>::infinity();
  return ranges_m;
}

/// Sound travels 90 km in this time, beyond the range of any modem.
constexpr double max_travel_s = 60;

}  // namespace

CoopAuv::CoopAuv(const Params& params, std::unique_ptr<HelmBehavior> behavior)
    : params_(params),
      behavior_(std::move(behavior)),
      access_(params.access, params.name),
      desired_depth_m_(params.depth_m) {
  const MarineEkf checked(0, Vector2d::Zero(), 1, params.filter);
}

void CoopAuv::note_time(std::int64_t utime) {
  // Reports arrive in order except for their latencies, many per second.  After a jump of their time stamps, time that
  // also passed for step() was silence, as after a power failure; the remainder was a change of the clock.
  const double silence_s = steps_in_silence_ * params_.period_s;
  steps_in_silence_ = 0;
  if (utime_ != 0) {
    const double set_s = seconds(utime - utime_) - silence_s;
    if (set_s < -late_s || set_s > max_gap_s) set_clock(std::llround(1e6 * set_s));
    if (seconds(utime - utime_) > max_gap_s) coast_over_silence(utime);
  }
  utime_ = std::max(utime_, utime);
}

void CoopAuv::set_clock(std::int64_t by_us) {
  ++counts_.clock_steps;
  utime_ += by_us;
  for (auto* time : {&attitude_utime_, &heading_utime_, &velocity_utime_, &fix_utime_, &first_fix_utime_})
    if (*time) **time += by_us;
  // The true part of it is unknown, so the next range has to determine the clock error.
  for (auto* filter : {&cooperative_, &dead_reckoning_})
    if (*filter)
      (*filter)->shift_clock(by_us, params_.sound_speed_mps * seconds(by_us), params_.sound_speed_mps * late_s);
}

void CoopAuv::coast_over_silence(std::int64_t utime) {
  ++counts_.silences;
  // It may have continued or stopped: the uncertainty is the entire distance.
  velocity_noise_mpsprtHz_ = std::max(coasting_mpsprtHz, v_B_.norm() * std::sqrt(seconds(utime - utime_)));
  predict(utime);
}

void CoopAuv::start(std::int64_t utime, const Vector2d& p_W, double std_m) {
  cooperative_.emplace(utime, p_W, std_m, params_.filter);
  dead_reckoning_.emplace(utime, p_W, std_m, params_.filter);
  first_fix_utime_ = utime;
  phase_ = Phase::at_surface;
}

void CoopAuv::predict(std::int64_t utime) {
  if (!q_WB_) return;
  const Eigen::Vector3d v_W = *q_WB_ * v_B_;
  double noise_mpsprtHz = velocity_noise_mpsprtHz_;
  if (heading_utime_ && seconds(utime - *heading_utime_) > oldest_attitude_s)
    noise_mpsprtHz = std::max(noise_mpsprtHz, v_B_.norm() * std::sqrt(lost_heading_s));
  for (auto* filter : {&cooperative_, &dead_reckoning_})
    if (*filter) (*filter)->predict(utime, v_W.head<2>(), noise_mpsprtHz);
}

Eigen::Vector3d CoopAuv::turned_into_world(const Eigen::Vector3d& point_B) const {
  return q_WB_.value_or(Eigen::Quaterniond::Identity()) * point_B;
}

bool CoopAuv::is_silent() const {
  // Of the counted steps, the first ends the period that contains the last report.
  return (steps_in_silence_ - 1) * params_.period_s > max_quiet_s;
}

void CoopAuv::receive(const shoal::dvl_t& dvl) {
  note_time(dvl.utime);
  const Eigen::Vector3d over_ground(dvl.velocity_mps[0], dvl.velocity_mps[1], dvl.velocity_mps[2]);
  const Eigen::Vector3d through_water(dvl.water_velocity_mps[0], dvl.water_velocity_mps[1], dvl.water_velocity_mps[2]);
  if (dvl.bottom_lock != 0 && over_ground.allFinite()) {
    v_B_ = over_ground;
    velocity_noise_mpsprtHz_ = 0;
  } else if (dvl.water_lock != 0 && through_water.allFinite()) {
    v_B_ = through_water;
    velocity_noise_mpsprtHz_ = through_water_mpsprtHz;
  } else {
    return;
  }
  velocity_utime_ = dvl.utime;
  if (!cooperative_ && params_.start_W && q_WB_) start(dvl.utime, *params_.start_W, params_.start_std_m);
  predict(dvl.utime);
}

void CoopAuv::receive(const shoal::ins_t& attitude) {
  note_time(attitude.utime);
  const Eigen::Quaterniond q(attitude.quat[0], attitude.quat[1], attitude.quat[2], attitude.quat[3]);
  if (!(std::abs(q.norm() - 1) < 0.01)) return;
  q_WB_ = Eigen::AngleAxisd(params_.yaw_offset_rad, Eigen::Vector3d::UnitZ()) * q.normalized();
  attitude_utime_ = heading_utime_ = attitude.utime;
}

void CoopAuv::receive(const shoal::compass_t& compass) {
  note_time(compass.utime);
  if (attitude_utime_ && seconds(utime_ - *attitude_utime_) < oldest_attitude_s) return;
  if (!std::isfinite(compass.heading_true_rad)) return;
  const double yaw_rad = 0.5 * std::numbers::pi - compass.heading_true_rad + params_.yaw_offset_rad;
  q_WB_ = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
  heading_utime_ = compass.utime;
}

void CoopAuv::receive(const shoal::pressure_t& pressure) {
  note_time(pressure.utime);
  if (std::isfinite(pressure.depth_m)) depth_m_ = pressure.depth_m;
}

void CoopAuv::receive(const shoal::gps_data_t& fix) {
  note_time(fix.utime);
  const Vector2d p_W = Vector2d(fix.xyz_pos[0], fix.xyz_pos[1]) - turned_into_world(params_.gps_B).head<2>();
  if (fix.gps_lock < 1 || !p_W.allFinite() || !(fix.horizontal_accuracy > 0)) return;
  if (!cooperative_) {
    if (!q_WB_) return;
    start(fix.utime, p_W, fix.horizontal_accuracy);
  } else if (fix_utime_ && seconds(fix.utime - *fix_utime_) < params_.fix_period_s) {
    return;
  } else {
    cooperative_->update_position(fix.utime, p_W, fix.horizontal_accuracy);
    dead_reckoning_->update_position(fix.utime, p_W, fix.horizontal_accuracy);
  }
  fix_utime_ = fix.utime;
}

void CoopAuv::receive(const shoal::acoustic_received_t& packet) {
  if (const auto order = order_in(packet)) {
    ++counts_.frames;
    execute(*order);
    return;
  }
  const auto state = state_in(packet);
  if (!state) {
    ++counts_.bad_frames;
    return;
  }
  ++counts_.frames;
  if (state->sender == params_.id || !direct_.is_direct(packet, *state)) {
    ++counts_.relayed;
    return;
  }
  behavior_->receive_state(packet.source, motion_of(*state));
  if (cooperative_ && params_.use_ranges) use_range(packet, *state);
}

Motion CoopAuv::motion_at(const MarineEkf& filter, std::int64_t utime) const {
  Motion motion{utime, filter.position_at(utime), filter.velocity()};
  if (q_WB_) motion.yaw_rad = sim::wrap_angle(sim::yaw_of(q_WB_->toRotationMatrix()) + filter.heading_bias_rad());
  return motion;
}

void CoopAuv::receive(const shoal::multibeam_t& ping) {
  note_time(ping.utime);
  if (!cooperative_ || ping.count < 2) return;
  const double step_rad = ping.angles_rad[1] - ping.angles_rad[0];
  behavior_->receive_scan({scan_of(ping), ping.angles_rad[0], step_rad}, motion_at(steered_by(), ping.utime));
}

OrderRefusal CoopAuv::refusal_of(const AcousticOrder& order) const {
  if (order.depth_m > params_.order_depth_max_m) return OrderRefusal::too_deep;
  if (order.speed_mps > params_.order_speed_max_mps) return OrderRefusal::too_fast;
  return OrderRefusal::none;
}

void CoopAuv::execute(const AcousticOrder& order) {
  if (!params_.execute || order.receiver != params_.id || order.number <= std::max(order_, refused_order_)) return;
  refusal_ = refusal_of(order);
  refused_order_ = refusal_ == OrderRefusal::none ? 0 : order.number;
  if (refused_order_ != 0) {
    ++counts_.orders_refused;
    return;
  }
  CircleBehavior::Params hold;
  hold.center_W = {order.east_m, order.north_m};
  hold.radius_m = params_.hold_radius_m;
  hold.speed_mps = order.speed_mps;
  behavior_ = std::make_unique<HoldBehavior>(hold);
  desired_depth_m_ = order.depth_m;
  order_ = order.number;
  ++counts_.orders;
  if (phase_ == Phase::done) phase_ = Phase::under_way;
}

void CoopAuv::use_range(const shoal::acoustic_received_t& packet, const AcousticState& beacon) {
  if (!(std::abs(packet.travel_time_s) < max_travel_s)) {
    ++counts_.refused;
    return;
  }
  MarineEkf::Range range;
  range.beacon = beacon.sender;
  range.utime = packet.utime;
  range.range_m = packet.travel_time_s * params_.sound_speed_mps;
  range.std_m = std::hypot(params_.range_std_m, params_.sound_speed_std * range.range_m);
  // Moves the beacon by the offset of the modem, which gives the range to the vehicle's reference point.
  const Eigen::Vector3d modem_W = turned_into_world(params_.modem_B);
  range.p_WS.head<2>() = position_at(beacon, packet.sent_utime) - modem_W.head<2>();
  range.p_WS.z() = -beacon.depth_m;
  const double covariance_m2 = beacon.correlation * beacon.east_std_m * beacon.north_std_m;
  range.beacon_covariance << beacon.east_std_m * beacon.east_std_m, covariance_m2, covariance_m2,
      beacon.north_std_m * beacon.north_std_m;
  range.own_z_m = modem_W.z() - depth_m_;
  const MarineEkf::Outcome outcome = cooperative_->update_range(range, &*dead_reckoning_);
  const bool used = outcome == MarineEkf::Outcome::accepted || outcome == MarineEkf::Outcome::inflated;
  ++(used ? counts_.ranges : counts_.refused);
}

void CoopAuv::update_phase() {
  const bool has_waited = first_fix_utime_ && seconds(utime_ - *first_fix_utime_) >= params_.surface_s;
  if (phase_ == Phase::at_surface && (has_waited || params_.start_W)) phase_ = Phase::under_way;
  if (phase_ == Phase::under_way && behavior_->finished()) phase_ = Phase::done;
}

CoopAuv::Decision CoopAuv::step() {
  Decision decision;
  ++steps_in_silence_;
  if (utime_ == 0) return decision;
  if (velocity_utime_ && seconds(utime_ - *velocity_utime_) > coast_after_s) {
    velocity_noise_mpsprtHz_ = coasting_mpsprtHz;
    predict(utime_);
  }
  update_phase();
  decision.helm = helm();
  if (!cooperative_ || is_silent()) return decision;  // no new data
  decision.estimate = estimate(*cooperative_);
  decision.dead_reckoning = estimate(*dead_reckoning_);
  if (access_.take_turn(utime_)) decision.send = state_frame();
  return decision;
}

shoal::helm_command_t CoopAuv::helm() {
  shoal::helm_command_t helm{utime_, 0, unknown, 0, unknown};
  if (phase_ != Phase::under_way) return helm;
  const Course course = behavior_->steer(motion_at(steered_by(), utime_));
  helm.speed_mps = course.speed_mps;
  helm.heading_rad = course.heading_rad;
  helm.depth_m = desired_depth_m_;
  return helm;
}

shoal::estimate_t CoopAuv::estimate(const MarineEkf& filter) const {
  shoal::estimate_t estimate{};
  estimate.utime = utime_;
  const Vector2d p_W = filter.position_at(utime_);
  const Vector2d v_W = filter.velocity();
  const Eigen::Matrix2d P = filter.position_covariance();
  for (int i = 0; i < 2; ++i) {
    estimate.position_m[i] = p_W[i];
    estimate.velocity_mps[i] = v_W[i];
    for (int j = 0; j < 2; ++j) estimate.covariance_m2[3 * i + j] = P(i, j);
  }
  estimate.position_m[2] = -depth_m_;
  estimate.covariance_m2[8] = pressure_std_m * pressure_std_m;
  const Eigen::Quaterniond q_WB = q_WB_.value_or(Eigen::Quaterniond::Identity());
  estimate.velocity_mps[2] = (q_WB * v_B_).z();
  estimate.yaw_rad = sim::wrap_angle(sim::yaw_of(q_WB.toRotationMatrix()) + filter.heading_bias_rad());
  estimate.clock_error_s = params_.filter.states > 4 ? filter.range_bias_m() / params_.sound_speed_mps : unknown;
  return estimate;
}

std::optional<shoal::modem_send_t> CoopAuv::state_frame() {
  const Vector2d p_W = cooperative_->position_at(utime_);
  const Vector2d v_W = cooperative_->velocity();
  const Eigen::Matrix2d P = cooperative_->position_covariance();
  AcousticState state;
  state.sender = params_.id;
  state.utime = utime_;
  state.east_m = p_W.x();
  state.north_m = p_W.y();
  state.depth_m = std::max(0.0, depth_m_);
  state.east_std_m = std::sqrt(P(0, 0));
  state.north_std_m = std::sqrt(P(1, 1));
  state.correlation = std::clamp(P(0, 1) / std::sqrt(P(0, 0) * P(1, 1)), -1.0, 1.0);
  state.speed_mps = v_W.norm();
  state.course_rad = std::atan2(v_W.y(), v_W.x());
  state.order = order_;
  state.refused_order = refused_order_;
  state.refusal = refusal_;
  auto message = to_everybody(state);
  if (message) ++counts_.sent;
  return message;
}

}  // namespace autonomy
