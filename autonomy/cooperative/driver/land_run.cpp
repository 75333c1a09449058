// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/land_run.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "autonomy/acomms/state_packet.hpp"
#include "autonomy/cooperative/driver/land_team.hpp"

namespace navigation {

namespace {

constexpr double oldest_payload_s = 3;

Setup land_setup(const NavTeam& team, int own, const NavOptions& options) {
  Setup setup;
  setup.team = team.members();
  setup.own = own;
  setup.position_W = team.vehicles[static_cast<std::size_t>(own)].land->X_WV.translation().head<2>();
  setup.position_std_m = land_start_std_m;
  return completed(setup, options);
}

shoal::estimate_t land_message(const Estimate& estimate, std::int64_t utime, double heading_rad) {
  shoal::estimate_t message = autonomy::estimate_message(utime, estimate.p_W, estimate.v_W, estimate.P);
  message.covariance_m2[8] = 1;
  message.yaw_rad = std::remainder(heading_rad + estimate.heading_bias_rad, 2 * std::numbers::pi);
  return message;
}

/// Refers a relative measurement to where the other vehicle was before it traveled this distance.
void move_back(Relative& seen, const Vector2& traveled_W) {
  const Vector2 d_W = seen.range_m * Vector2(std::cos(seen.bearing_rad), std::sin(seen.bearing_rad)) - traveled_W;
  seen.range_m = d_W.norm();
  seen.bearing_rad = std::atan2(d_W.y(), d_W.x());
}

/// One estimator in each vehicle, and the frames that they exchange by radio.
class OwnOnLand final : public TeamEstimator {
 public:
  OwnOnLand(const Algorithm& algorithm, std::size_t frame_bytes, bool has_radio, OfflineRun& run)
      : algorithm_(algorithm), room_(payload_room(frame_bytes)), has_radio_(has_radio), run_(run) {}

  void start(int, const Setup& setup) override {
    vehicles_.push_back(algorithm_.make());
    vehicles_.back()->start(setup);
    waiting_.emplace_back();
  }
  void predict(int vehicle, Time time, const Vector2& v_W, const Matrix2& q) override {
    at(vehicle).predict(time, v_W, q);
  }
  void fix(int vehicle, Time time, const Vector2& p_W, double std_m) override { at(vehicle).fix(time, p_W, std_m); }
  void sent(int vehicle, Time time) override {
    frames_[{vehicle, time}] = {time, at(vehicle).now(time).v_W, make_payload(vehicle, time)};
  }
  void on_range(int vehicle, const ReceivedRange& received) override {
    if (const auto frame = frames_.find({received.sender, received.payload_time}); frame != frames_.end())
      waiting_[static_cast<std::size_t>(vehicle)][received.sender] = frame->second;
  }
  void on_bearing(int vehicle, const Relative& relative) override {
    Relative seen = relative;
    const Bytes payload = has_radio_ ? payload_waiting(vehicle, seen) : make_payload(seen.other, seen.time);
    if (!has_radio_) seen.payload_time = seen.time;
    seen.payload = payload;
    at(vehicle).on_bearing(seen);
  }
  Estimate now(int vehicle, Time time) const override {
    return vehicles_[static_cast<std::size_t>(vehicle)]->now(time);
  }

 private:
  struct Frame {
    Time time = 0;
    Vector2 v_W = Vector2::Zero();
    Bytes payload;
  };

  Estimator& at(int vehicle) { return *vehicles_[static_cast<std::size_t>(vehicle)]; }
  Bytes make_payload(int vehicle, Time time) {
    Bytes payload = at(vehicle).make_payload(time, room_);
    if (payload.size() > room_)
      throw std::invalid_argument(algorithm_.name + " said " + std::to_string(payload.size()) +
                                  " bytes, its frames have room for " + std::to_string(room_));
    ++run_.frames_said;
    run_.payload_bytes[static_cast<std::size_t>(vehicle)] += payload.size();
    return payload;
  }
  /// Takes the newest payload of the vehicle that was seen, unless it is too old, and refers the measurement to its
  /// time.
  Bytes payload_waiting(int vehicle, Relative& seen) {
    auto& waiting = waiting_[static_cast<std::size_t>(vehicle)];
    const auto newest = waiting.find(seen.other);
    if (newest == waiting.end() || newest->second.time > seen.time) return {};
    const Frame frame = std::move(newest->second);
    waiting.erase(newest);
    const double age_s = seconds(seen.time - frame.time);
    if (age_s > oldest_payload_s) return {};
    seen.payload_time = frame.time;
    move_back(seen, frame.v_W * age_s);
    return frame.payload;
  }

  const Algorithm& algorithm_;
  std::size_t room_;
  bool has_radio_;
  OfflineRun& run_;
  std::vector<std::unique_ptr<Estimator>> vehicles_;
  std::map<std::pair<int, Time>, Frame> frames_;  ///< by sender and time of transmission
  std::vector<std::map<int, Frame>> waiting_;     ///< newest that was received, by vehicle and sender
};

}  // namespace

LandRun::LandRun(const NavRecord& record, const Algorithm& algorithm, const std::vector<NavOptions>& options,
                 OfflineRun& run)
    : record_(record),
      run_(run),
      events_(land_events_of(record)),
      needs_payloads_(!algorithm.make_team),
      has_radio_(
          std::any_of(record.items.begin(), record.items.end(),
                      [](const auto& item) { return std::holds_alternative<shoal::modem_send_t>(item.message); })),
      walks_(options.size()),
      period_us_(options.front().period_us) {
  if (needs_payloads_)
    team_ = std::make_unique<OwnOnLand>(algorithm, options.front().frame_bytes, has_radio_, run);
  else
    team_ = algorithm.make_team();
  for (std::size_t i = 0; i < options.size(); ++i)
    team_->start(static_cast<int>(i), land_setup(*record.team, static_cast<int>(i), options[i]));
}

void LandRun::walk(int vehicle, Time time, bool part) {
  const auto& segments = events_.tracks[static_cast<std::size_t>(vehicle)].segments();
  Walk& walked = walks_[static_cast<std::size_t>(vehicle)];
  const auto move = [&](Time to) {
    if (to <= walked.moved_to) return;
    team_->predict(vehicle, to, segments[walked.next].v_W, segments[walked.next].q);
    walked.moved_to = to;
  };
  for (; walked.next < segments.size() && segments[walked.next].to <= time; ++walked.next)
    move(segments[walked.next].to);
  if (part && walked.next < segments.size()) move(time);
}

void LandRun::ticks_before(Time time) {
  for (; tick_us_ < time && tick_us_ <= record_.end_us; tick_us_ += period_us_)
    for (std::size_t i = 0; i < walks_.size(); ++i) {
      const int vehicle = static_cast<int>(i);
      walk(vehicle, tick_us_, false);
      run_.estimates[i].push_back({tick_us_, land_message(team_->now(vehicle, tick_us_), tick_us_ + record_.epoch_utime,
                                                          events_.tracks[i].heading_rad(tick_us_))});
    }
}

void LandRun::tell(int vehicle, const NavEvent& event) {
  using Kind = NavEvent::Kind;
  walk(vehicle, event.time, true);
  switch (event.kind) {
    case Kind::motion:
      break;
    case Kind::fix:
      team_->fix(vehicle, event.time, event.p_W, event.std_m);
      break;
    case Kind::bearing:
      // The other vehicle has a part in it: as a state, or with a payload of this instant.
      if (!needs_payloads_ || !has_radio_) walk(event.seen.other, event.time, true);
      team_->on_bearing(vehicle, event.seen);
      ++run_.ranges;
      break;
    case Kind::payload:
      if (needs_payloads_) team_->sent(vehicle, event.time);
      break;
    case Kind::received:
      if (needs_payloads_) team_->on_range(vehicle, event.received);
      break;
  }
}

void LandRun::play() {
  for (const auto& [vehicle, event] : events_.events) {
    if (event.time < 0) continue;
    ticks_before(event.time);
    tell(vehicle, event);
  }
  ticks_before(record_.end_us + 1);
}

}  // namespace navigation
