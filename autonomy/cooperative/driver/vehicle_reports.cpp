// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/vehicle_reports.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "autonomy/acomms/state_packet.hpp"

namespace navigation {

using autonomy::max_travel_s;

namespace {

/// After a longer time without velocities the vehicle may have stopped or gone on.
constexpr double max_silence_s = autonomy::ReportClock::max_gap_s;
/// A transmission that began later or earlier than planned is not that for which the payload was time.
constexpr double max_late_s = 0.3;
/// An older relative measurement is not sent.
constexpr double max_relative_age_s = 5;
/// A relative measurement by a clock that is further ahead of the own one is not used.
constexpr double max_ahead_s = 1;
/// Times of relative measurements in frames have milliseconds: one that was sent again differs by less than this.
constexpr double same_sight_s = 0.01;

Time microseconds(double time_s) {
  return static_cast<Time>(std::llround(1e6 * time_s));
}

}  // namespace

VehicleReports::VehicleReports(std::shared_ptr<const NavTeam> team, int own, const Start& start, SoundModel sound,
                               double period_s)
    : team_(std::move(team)), own_(own), start_(start), sound_(sound), clock_(period_s) {}

Time VehicleReports::note_time(std::int64_t utime) {
  offset_ -= clock_.note(utime).set_us;
  return utime + offset_;
}

void VehicleReports::begin(Time time, const Vector2& modem_W, double std_m) {
  setup_.emplace();
  setup_->team = team_->members();
  setup_->own = own_;
  setup_->time = time;
  setup_->position_W = modem_W;
  setup_->position_std_m = std_m;
  setup_->sound_speed_mps = team_->sound.mean_speed_mps(0, 20);
  moved_to_ = time;
}

NavEvent VehicleReports::motion_event(Time time, const Vector2& v_W, const Matrix2& q, const Eigen::Vector3d& point_B) {
  NavEvent event;
  event.time = time;
  event.q = q;
  const double dt_s = moved_to_ ? seconds(time - *moved_to_) : 0;
  // The mean of both ends; of the first report, or after silence, the end alone.
  event.v_W = dt_s > 0 && dt_s <= max_silence_s && has_velocity_ ? Vector2(0.5 * (v_W_ + v_W)) : v_W;
  // The modem turns about the point whose velocity was measured.
  const Vector2 lever_now_W = lever_W(own_vehicle().modem->X_BS.translation() - point_B).head<2>();
  if (dt_s > 0) event.v_W += (lever_now_W - lever_then_W_) / dt_s;
  lever_then_W_ = lever_now_W;
  if (dt_s > max_silence_s) event.q += v_W.squaredNorm() * dt_s * Matrix2::Identity();
  if (moved_to_) moved_to_ = std::max(*moved_to_, time);
  v_W_ = v_W;
  has_velocity_ = true;
  return event;
}

std::vector<NavEvent> VehicleReports::receive(const shoal::dvl_t& dvl) {
  const Time time = note_time(dvl.utime);
  const NavVehicle& own = own_vehicle();
  const auto velocity = autonomy::velocity_of(dvl);
  if (!velocity || !attitude_.is_known()) return {};
  const Eigen::Vector3d v_3d_W = lever_W(own.dvl->X_BS.linear() * velocity->v_S);
  // The mean of vectors that are turned by white noise is shorter than they are.
  const Vector2 v_W = std::exp(0.5 * own.heading_white_rad * own.heading_white_rad) * v_3d_W.head<2>();
  const double dt_s = moved_to_ ? std::clamp(seconds(time - *moved_to_), 0.0, 1.0) : 0;
  if (!setup_ && start_.p_W) {
    begin(time, *start_.p_W + lever_W(own.modem->X_BS.translation()).head<2>(), start_.std_m);
    lever_then_W_ = lever_W(own.modem->X_BS.translation() - own.dvl->X_BS.translation()).head<2>();
  }
  if (!setup_) return {};
  // White errors of velocity and heading, as densities.
  const double fom_mps = std::isfinite(dvl.fom_mps) ? dvl.fom_mps : 0;
  const double density = own.velocity_share * fom_mps * fom_mps * dt_s + own.velocity_density +
                         autonomy::squared(velocity->noise_mpsprtHz());
  const Vector2 left_W(-v_W.y(), v_W.x());
  const Matrix2 q = density * Matrix2::Identity() +
                    own.heading_white_rad * own.heading_white_rad * dt_s * (left_W * left_W.transpose());
  return {motion_event(time, v_W, q, own.dvl->X_BS.translation())};
}

std::vector<NavEvent> VehicleReports::receive(const shoal::ins_t& attitude) {
  const Time time = note_time(attitude.utime);
  attitude_.receive(time, attitude, Eigen::Quaterniond(own_vehicle().ahrs->X_BS.linear()));
  return {};
}

std::vector<NavEvent> VehicleReports::receive(const shoal::compass_t& compass) {
  const Time time = note_time(compass.utime);
  attitude_.receive(time, compass);
  return {};
}

std::vector<NavEvent> VehicleReports::receive(const shoal::pressure_t& pressure) {
  note_time(pressure.utime);
  if (std::isfinite(pressure.depth_m))
    depth_m_ = pressure.depth_m + lever_W(own_vehicle().pressure->X_BS.translation()).z();
  return {};
}

std::vector<NavEvent> VehicleReports::receive(const shoal::gps_data_t& fix) {
  const Time time = note_time(fix.utime);
  const NavVehicle& own = own_vehicle();
  const Vector2 antenna_W(fix.xyz_pos[0], fix.xyz_pos[1]);
  if (fix.gps_lock < 1 || !antenna_W.allFinite()) return {};
  const bool by_dvl = own.dvl.has_value();
  if (by_dvl && !attitude_.is_known()) return {};
  const Eigen::Vector3d antenna_B = own.gps->X_BS.translation();
  const Vector2 modem_W = antenna_W + lever_W(own.modem->X_BS.translation() - antenna_B).head<2>();
  std::vector<NavEvent> events;
  if (!setup_) {
    begin(time, modem_W, std::hypot(own.fix_std_m, own.errors.slow_fix_m));
    const Eigen::Vector3d moving_B = by_dvl ? own.dvl->X_BS.translation() : antenna_B;
    lever_then_W_ = lever_W(own.modem->X_BS.translation() - moving_B).head<2>();
    return {};
  }
  if (!by_dvl && std::isfinite(fix.speed) && std::isfinite(fix.heading)) {
    const double course_rad = 0.5 * std::numbers::pi - fix.heading;
    const Vector2 v_W = fix.speed * Vector2(std::cos(course_rad), std::sin(course_rad));
    events.push_back(motion_event(time, v_W, own.velocity_density * Matrix2::Identity(), antenna_B));
  }
  NavEvent event;
  event.kind = NavEvent::Kind::fix;
  event.time = time;
  event.p_W = modem_W;
  event.std_m = own.fix_std_m;
  events.push_back(event);
  return events;
}

Relative VehicleReports::relative_of(const NavVehicle& observer, const Eigen::Vector3d& d_W) {
  const double level_m = d_W.head<2>().norm();
  Relative seen;
  seen.range_m = level_m;
  seen.bearing_rad = std::atan2(d_W.y(), d_W.x());
  // A report is up to a period late, as ranges are.
  const experiment::UsblErrors::Plane variances = observer.usbl_errors.at(d_W);
  const double across_m = std::hypot(std::sqrt(variances.across_m2), VehicleReports::min_range_std_m);
  // Near the vertical an error across makes the level too long: sqrt(level^2 + across^2), at most by itself.
  const double longer_m = std::hypot(level_m, across_m) - level_m;
  seen.range_std_m = std::hypot(std::sqrt(variances.along_m2), longer_m, VehicleReports::min_range_std_m);
  seen.bearing_std_rad = across_m / std::max(level_m, 1.0);
  return seen;
}

std::vector<NavEvent> VehicleReports::receive(const shoal::usbl_t& relative) {
  const Time time = note_time(relative.utime);
  const Eigen::Vector3d p_S(relative.position_m[0], relative.position_m[1], relative.position_m[2]);
  // A transponder is VEHICLE/DEVICE.
  const auto other = team_->index_of(relative.target.substr(0, relative.target.find('/')));
  if (!setup_ || !attitude_.is_known() || !other || *other == own_ || !p_S.allFinite()) return {};
  const NavVehicle& own = own_vehicle();
  const Eigen::Vector3d d_W = lever_W(own.usbl->X_BS * p_S - own.modem->X_BS.translation());
  relatives_[*other] = {time, d_W.head<2>()};
  NavEvent event;
  event.kind = NavEvent::Kind::bearing;
  event.time = time;
  event.seen = relative_of(own, d_W);
  event.seen.time = time;
  event.seen.other = *other;
  return {event};
}

bool VehicleReports::is_from_sender(const shoal::acoustic_received_t& packet, const NavFrame& frame) const {
  const auto sender = team_->index_of(packet.source);
  // A frame that was forwarded has another source.
  return setup_ && sender && *sender == frame.sender && *sender != own_ &&
         std::abs(seconds(packet.sent_utime - frame.payload_time)) <= max_late_s;
}

std::optional<NavEvent> VehicleReports::bearing_by(const shoal::acoustic_received_t& packet, const NavFrame& frame) {
  const auto relative = std::find_if(frame.relatives.begin(), frame.relatives.end(),
                                     [this](const NavFrame::RelativePosition& each) { return each.other == own_; });
  if (!is_from_sender(packet, frame) || relative == frame.relatives.end()) return std::nullopt;
  const NavVehicle& observer = team_->vehicles[static_cast<std::size_t>(frame.sender)];
  NavEvent event;
  event.kind = NavEvent::Kind::bearing;
  event.time = frame.payload_time - relative->age + offset_;
  // Its time is by the clock of the sender, which may be wrong by hours.
  const double before_arrival_s = seconds(packet.utime + offset_ - event.time);
  if (!(before_arrival_s >= -max_ahead_s && before_arrival_s <= max_travel_s + max_relative_age_s)) return std::nullopt;
  const auto before = seen_at_.find(frame.sender);
  if (before != seen_at_.end() && seconds(event.time - before->second) < same_sight_s) return std::nullopt;
  seen_at_[frame.sender] = event.time;
  event.seen = relative_of(observer, {-relative->d_W.x(), -relative->d_W.y(), modem_depth_m() - frame.depth_m});
  event.seen.time = event.time;
  event.seen.other = frame.sender;
  event.seen.by_other = true;
  // Lasting errors of the heading of another vehicle are unknown.
  event.seen.bearing_std_rad =
      std::hypot(event.seen.bearing_std_rad, observer.errors.heading_bias_rad, observer.errors.slow_heading_rad);
  event.seen.payload_time = frame.payload_time;
  event.payload = frame.payload;
  return event;
}

std::optional<NavEvent> VehicleReports::range_event(const shoal::acoustic_received_t& packet, const NavFrame& frame) {
  if (!is_from_sender(packet, frame) || !(std::abs(packet.travel_time_s) < max_travel_s)) return std::nullopt;
  const auto range_m = team_->sound.range_m(sound_, packet.travel_time_s, modem_depth_m(), frame.depth_m);
  if (!range_m) return std::nullopt;
  NavEvent event;
  event.kind = NavEvent::Kind::received;
  event.time = packet.utime + offset_;
  event.received.toa = event.time;
  event.received.tol = packet.sent_utime;
  event.received.sender = frame.sender;
  event.received.range_m = *range_m;
  event.received.std_m = range_std_m(frame.sender, *range_m, frame.depth_m);
  event.received.own_z_m = -modem_depth_m();
  event.received.sender_z_m = -frame.depth_m;
  event.received.payload_time = frame.payload_time;
  event.payload = frame.payload;
  return event;
}

double VehicleReports::range_std_m(int sender, double range_m, double sender_depth_m) const {
  const NavVehicle& own = own_vehicle();
  const NavVehicle& other = team_->vehicles[static_cast<std::size_t>(sender)];
  const double speed_mps = team_->sound.mean_speed_mps(modem_depth_m(), sender_depth_m);
  const double slope = std::min(1.0, std::abs(modem_depth_m() - sender_depth_m) / std::max(std::abs(range_m), 1e-3));
  const double stamps_m = speed_mps * std::hypot(own.stamp_std_s, other.stamp_std_s);
  return std::max(min_range_std_m, std::hypot(stamps_m, slope * own.depth_std_m, slope * other.depth_std_m));
}

Time VehicleReports::transmission() const {
  const Time interval = microseconds(own_vehicle().synchronous_s);
  if (interval <= 0) return time();
  return (clock_.time() + interval - 1) / interval * interval + offset_;
}

double VehicleReports::modem_depth_m() const {
  return depth_m_ - lever_W(own_vehicle().modem->X_BS.translation()).z();
}

NavFrame VehicleReports::frame(Time time, Bytes payload) const {
  NavFrame frame{own_, time - offset_, modem_depth_m(), std::move(payload)};
  for (const auto& [other, relative] : relatives_)
    if (const double age_s = seconds(time - relative.time); age_s >= 0 && age_s <= max_relative_age_s)
      frame.relatives.push_back({other, time - relative.time, relative.d_W - age_s * v_W_});
  return frame;
}

shoal::estimate_t VehicleReports::message(const Estimate& estimate) const {
  const Vector2 p_W = estimate.p_W - lever_W(own_vehicle().modem->X_BS.translation()).head<2>();
  shoal::estimate_t message = autonomy::estimate_message(clock_.time(), p_W, estimate.v_W, estimate.P);
  autonomy::set_depth(message, depth_m_);
  if (!own_vehicle().pressure) message.covariance_m2[8] = 1;  // it floats
  const double measured_rad = attitude_.is_known() ? attitude_.yaw_rad() : std::atan2(v_W_.y(), v_W_.x());
  message.yaw_rad = std::remainder(measured_rad + estimate.heading_bias_rad, 2 * std::numbers::pi);
  message.clock_error_s = estimate.clock_error_s;
  return message;
}

}  // namespace navigation
