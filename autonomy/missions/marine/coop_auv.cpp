// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/coop_auv.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/math.hpp"
namespace autonomy {

namespace {

/// Noise of an old velocity, which has changed.
constexpr double coasting_mpsprtHz = 0.5;
/// Time without a velocity, after which it extrapolates the last one.
constexpr double coast_after_s = 1;
/// Correlation time of the error of an unknown heading.
constexpr double lost_heading_s = 60;

/// Returns the ranges of a ping; infinity without an echo.
std::vector<float> scan_of(const shoal::multibeam_t& ping) {
  std::vector<float> ranges_m = ping.ranges_m;
  for (std::size_t i = 0; i < ranges_m.size(); ++i)
    if (ping.valid[i] == 0) ranges_m[i] = std::numeric_limits<float>::infinity();
  return ranges_m;
}

}  // namespace

CoopAuv::CoopAuv(const Params& params, std::unique_ptr<HelmBehavior> behavior)
    : params_(params),
      behavior_(std::move(behavior)),
      access_(params.access, params.name),
      desired_depth_m_(params.depth_m),
      clock_(params.period_s),
      phases_(params.start_W ? 0 : params.surface_s) {
  const MarineEkf checked(0, Vector2d::Zero(), 1, params.filter);
}

void CoopAuv::note_time(std::int64_t utime) {
  const ReportClock::Jump jump = clock_.note(utime);
  if (jump.set_us != 0) set_clock(jump.set_us);
  if (jump.silent_s == 0) return;
  ++counts_.silences;
  // It may have continued or stopped: the uncertainty is the entire distance.
  velocity_noise_mpsprtHz_ = std::max(coasting_mpsprtHz, v_B_.norm() * std::sqrt(jump.silent_s));
  predict(utime);
}

void CoopAuv::set_clock(std::int64_t by_us) {
  ++counts_.clock_steps;
  attitude_.shift(by_us);
  phases_.shift(by_us);
  for (auto* time : {&velocity_utime_, &fix_utime_})
    if (*time) **time += by_us;
  // The true part of it is unknown, so the next range has to determine the clock error.
  if (filter_)
    filter_->shift_clock(by_us, params_.sound_speed_mps * seconds(by_us),
                         params_.sound_speed_mps * ReportClock::late_s);
}

void CoopAuv::start(std::int64_t utime, const Vector2d& p_W, double std_m) {
  filter_.emplace(utime, p_W, std_m, params_.filter);
  phases_.begin(utime);
}

void CoopAuv::predict(std::int64_t utime) {
  if (!filter_ || !attitude_.is_known()) return;
  const Eigen::Vector3d v_W = attitude_.q_WB() * v_B_;
  double noise_mpsprtHz = velocity_noise_mpsprtHz_;
  if (attitude_.is_lost(utime)) noise_mpsprtHz = std::max(noise_mpsprtHz, v_B_.norm() * std::sqrt(lost_heading_s));
  filter_->predict(utime, v_W.head<2>(), noise_mpsprtHz);
}

void CoopAuv::receive(const shoal::dvl_t& dvl) {
  note_time(dvl.utime);
  const auto velocity = velocity_of(dvl);
  if (!velocity) return;
  v_B_ = velocity->v_S;
  velocity_noise_mpsprtHz_ = velocity->noise_mpsprtHz();
  velocity_utime_ = dvl.utime;
  if (!filter_ && params_.start_W && attitude_.is_known()) start(dvl.utime, *params_.start_W, params_.start_std_m);
  predict(dvl.utime);
}

void CoopAuv::receive(const shoal::ins_t& attitude) {
  note_time(attitude.utime);
  attitude_.receive(attitude.utime, attitude);
}

void CoopAuv::receive(const shoal::compass_t& compass) {
  note_time(compass.utime);
  attitude_.receive(compass.utime, compass);
}

void CoopAuv::receive(const shoal::pressure_t& pressure) {
  note_time(pressure.utime);
  if (std::isfinite(pressure.depth_m)) depth_m_ = pressure.depth_m;
}

void CoopAuv::receive(const shoal::gps_data_t& fix) {
  note_time(fix.utime);
  const Vector2d p_W = Vector2d(fix.xyz_pos[0], fix.xyz_pos[1]) - (attitude_.q_WB() * params_.gps_B).head<2>();
  if (fix.gps_lock < 1 || !p_W.allFinite() || !(fix.horizontal_accuracy > 0)) return;
  if (!filter_) {
    if (!attitude_.is_known()) return;
    start(fix.utime, p_W, fix.horizontal_accuracy);
  } else if (fix_utime_ && seconds(fix.utime - *fix_utime_) < params_.fix_period_s) {
    return;
  } else {
    filter_->update_position(fix.utime, p_W, fix.horizontal_accuracy);
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
  if (filter_ && params_.use_ranges) use_range(packet, *state);
}

Motion CoopAuv::motion_at(const MarineEkf& filter, std::int64_t utime) const {
  Motion motion{utime, filter.position_at(utime), filter.velocity()};
  if (attitude_.is_known()) motion.yaw_rad = yaw_by(filter);
  return motion;
}

void CoopAuv::receive(const shoal::multibeam_t& ping) {
  note_time(ping.utime);
  if (!filter_ || ping.count < 2) return;
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
  phases_.resume();
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
  const Eigen::Vector3d modem_W = attitude_.q_WB() * params_.modem_B;
  range.p_WS.head<2>() = position_at(beacon, packet.sent_utime) - modem_W.head<2>();
  range.p_WS.z() = -beacon.depth_m;
  range.beacon_covariance = covariance_of(beacon);
  range.own_z_m = modem_W.z() - depth_m_;
  ++(filter_->update_range(range) ? counts_.ranges : counts_.refused);
}

CoopAuv::Decision CoopAuv::step() {
  Decision decision;
  clock_.step();
  const std::int64_t utime = clock_.time();
  if (utime == 0) return decision;
  if (velocity_utime_ && seconds(utime - *velocity_utime_) > coast_after_s) {
    velocity_noise_mpsprtHz_ = coasting_mpsprtHz;
    predict(utime);
  }
  decision.helm = helm();
  if (!filter_ || clock_.is_silent()) return decision;  // no new data
  decision.estimate = estimate(*cooperative());
  decision.dead_reckoning = estimate(*dead_reckoning());
  if (access_.take_turn(utime)) decision.send = state_frame(*decision.estimate);
  return decision;
}

shoal::helm_command_t CoopAuv::helm() {
  shoal::helm_command_t helm{clock_.time(), 0, unknown, 0, unknown};
  if (phases_.update(clock_.time(), behavior_->finished()) != Phase::under_way) return helm;
  const Course course = behavior_->steer(motion_at(steered_by(), clock_.time()));
  helm.speed_mps = course.speed_mps;
  helm.heading_rad = course.heading_rad;
  helm.depth_m = desired_depth_m_;
  return helm;
}

double CoopAuv::yaw_by(const MarineEkf& filter) const {
  return sim::wrap_angle(attitude_.yaw_rad() + filter.heading_bias_rad());
}

shoal::estimate_t CoopAuv::estimate(const MarineEkf& filter) const {
  const std::int64_t utime = clock_.time();
  shoal::estimate_t estimate =
      estimate_message(utime, filter.position_at(utime), filter.velocity(), filter.position_covariance());
  set_depth(estimate, depth_m_);
  estimate.velocity_mps[2] = (attitude_.q_WB() * v_B_).z();
  estimate.yaw_rad = yaw_by(filter);
  estimate.clock_error_s = params_.filter.states > 4 ? filter.range_bias_m() / params_.sound_speed_mps : unknown;
  return estimate;
}

std::optional<shoal::modem_send_t> CoopAuv::state_frame(const shoal::estimate_t& estimate) {
  AcousticState state = state_of(estimate, params_.id);
  state.order = order_;
  state.refused_order = refused_order_;
  state.refusal = refusal_;
  auto message = to_everybody(state);
  if (message) ++counts_.sent;
  return message;
}

}  // namespace autonomy
