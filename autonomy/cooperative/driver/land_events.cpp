// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/land_events.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

namespace navigation {

namespace {

/// Least distance for which errors of coordinates become those of a bearing.
constexpr double min_seen_m = 0.1;

Matrix2 turn_by(double angle_rad) {
  return Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
}

/// Reader of the messages of a record, whose headings are known.
class LandEventMaker {
 public:
  LandEventMaker(const NavRecord& record, LandEvents& out) : record_(record), out_(out), sent_(out.tracks.size()) {}

  /// Odometry is in the tracks, and a land vehicle has no other devices.
  template <class Message>
  void add(const NavRecord::Item&, const Message&) {}
  void add(const NavRecord::Item& item, const shoal::gps_data_t& fix) {
    const Vector2 antenna_W(fix.xyz_pos[0], fix.xyz_pos[1]);
    if (fix.gps_lock < 1 || !antenna_W.allFinite()) return;
    NavEvent event = event_of(NavEvent::Kind::fix, fix.utime);
    const Vector2 lever_B = vehicle_of(item).gps->X_BS.translation().head<2>();
    event.p_W = antenna_W - turn_by(heading_rad(item, event.time)) * lever_B;
    event.std_m = vehicle_of(item).fix_std_m;
    out_.events.push_back({item.vehicle, event});
  }
  void add(const NavRecord::Item& item, const shoal::swarm_position_t& seen) {
    const LandVehicle& own = *vehicle_of(item).land;
    for (std::size_t i = 0; i < seen.vehicle.size(); ++i) {
      const auto other = record_.team->index_of(seen.vehicle[i]);
      const sim::Vector3d relative_S(seen.relative_m[i][0], seen.relative_m[i][1], seen.relative_m[i][2]);
      if (!other || *other == item.vehicle || !relative_S.allFinite()) continue;
      NavEvent event = event_of(NavEvent::Kind::bearing, seen.utime);
      const Vector2 d_B = (own.swarm->X_BS * relative_S).head<2>();
      event.seen.time = event.time;
      event.seen.other = *other;
      event.seen.range_m = d_B.norm();
      event.seen.bearing_rad = heading_rad(item, event.time) + std::atan2(d_B.y(), d_B.x());
      event.seen.range_std_m = own.range_std_m.value_or(own.seen_std_m);
      event.seen.bearing_std_rad =
          own.bearing_std_rad.value_or(own.seen_std_m / std::max(event.seen.range_m, min_seen_m));
      out_.events.push_back({item.vehicle, event});
    }
  }
  void add(const NavRecord::Item& item, const shoal::modem_send_t& send) {
    // Programs send at the simulated time of their decision.
    const NavEvent event = event_of(NavEvent::Kind::payload, item.time_us + record_.epoch_utime);
    auto& sent = sent_[static_cast<std::size_t>(item.vehicle)];
    sent.push_back({event.time, &send});
    if (sent.size() > max_under_way) sent.pop_front();
    out_.events.push_back({item.vehicle, event});
  }
  void add(const NavRecord::Item& item, const shoal::modem_received_t& packet) {
    const auto sender = record_.team->index_of(packet.source);
    if (!sender || *sender == item.vehicle) return;
    const auto& sent = sent_[static_cast<std::size_t>(*sender)];
    const auto found =
        std::find_if(sent.rbegin(), sent.rend(), [&](const auto& each) { return each.second->data == packet.data; });
    if (found == sent.rend()) return;
    NavEvent event = event_of(NavEvent::Kind::received, packet.utime);
    event.received.sender = *sender;
    event.received.payload_time = found->first;
    out_.events.push_back({item.vehicle, event});
  }

 private:
  /// A message arrives before its sender has sent that many more.
  static constexpr std::size_t max_under_way = 64;

  const NavVehicle& vehicle_of(const NavRecord::Item& item) const {
    return record_.team->vehicles[static_cast<std::size_t>(item.vehicle)];
  }
  double heading_rad(const NavRecord::Item& item, Time time) const {
    return out_.tracks[static_cast<std::size_t>(item.vehicle)].heading_rad(time);
  }
  NavEvent event_of(NavEvent::Kind kind, std::int64_t utime) const {
    NavEvent event;
    event.kind = kind;
    event.time = utime - record_.epoch_utime;
    return event;
  }

  const NavRecord& record_;
  LandEvents& out_;
  std::vector<std::deque<std::pair<Time, const shoal::modem_send_t*>>> sent_;  ///< newest by vehicle
};

}  // namespace

void OdometryTrack::add(Time time, const shoal::odometry_t& odometry) {
  if (!std::isfinite(odometry.x_m) || !std::isfinite(odometry.y_m) || !std::isfinite(odometry.theta_rad)) return;
  if (time_ && time <= *time_) return;
  if (time_ || time > 0) {
    // The first report refers to the start pose, at time 0 and with all numbers 0.
    const double start_rad = sim::yaw_of(vehicle_->X_WV.linear());
    Segment segment;
    segment.from = time_.value_or(0);
    segment.to = time;
    segment.from_heading_rad = start_rad + last_.theta_rad;
    segment.to_heading_rad = start_rad + odometry.theta_rad;
    const double dt_s = seconds(segment.to - segment.from);
    segment.v_W = turn_by(start_rad) * Vector2(odometry.x_m - last_.x_m, odometry.y_m - last_.y_m) / dt_s;
    const Matrix2 R = turn_by(0.5 * (segment.from_heading_rad + segment.to_heading_rad));
    segment.q = R * Vector2(vehicle_->along_density, vehicle_->across_density).asDiagonal() * R.transpose();
    segments_.push_back(segment);
  }
  time_ = time;
  last_ = odometry;
}

double OdometryTrack::heading_rad(Time time) const {
  const auto in = std::lower_bound(segments_.begin(), segments_.end(), time,
                                   [](const Segment& segment, Time at) { return segment.to < at; });
  if (in == segments_.end())
    return segments_.empty() ? sim::yaw_of(vehicle_->X_WV.linear()) : segments_.back().to_heading_rad;
  const double share = std::max(0.0, seconds(time - in->from) / seconds(in->to - in->from));
  return in->from_heading_rad + share * (in->to_heading_rad - in->from_heading_rad);
}

LandEvents land_events_of(const NavRecord& record) {
  LandEvents out;
  for (const NavVehicle& vehicle : record.team->vehicles) out.tracks.emplace_back(*vehicle.land);
  for (const NavRecord::Item& item : record.items)
    if (const auto* odometry = std::get_if<shoal::odometry_t>(&item.message))
      out.tracks[static_cast<std::size_t>(item.vehicle)].add(odometry->utime - record.epoch_utime, *odometry);
  LandEventMaker maker(record, out);
  for (const NavRecord::Item& item : record.items)
    std::visit([&](const auto& message) { maker.add(item, message); }, item.message);
  std::stable_sort(out.events.begin(), out.events.end(),
                   [](const auto& a, const auto& b) { return a.event.time < b.event.time; });
  return out;
}

}  // namespace navigation
