// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/land/land_offline.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "autonomy/cooperative/land/land_events.hpp"

namespace navigation {

namespace {

constexpr double oldest_payload_s = 3;

Setup land_setup(const LandRecord& record, int own, const NavOptions& options) {
  Setup setup;
  setup.team = record.land.members();
  setup.own = own;
  setup.position_W = record.land.vehicles[static_cast<std::size_t>(own)].X_WV.translation().head<2>();
  setup.position_std_m = LandTeam::start_std_m;
  return completed(setup, options);
}

shoal::estimate_t land_message(const Estimate& estimate, Time time, double heading_rad) {
  shoal::estimate_t message{};
  message.utime = time;
  for (int i = 0; i < 2; ++i) {
    message.position_m[i] = estimate.p_W[i];
    message.velocity_mps[i] = estimate.v_W[i];
    for (int j = 0; j < 2; ++j) message.covariance_m2[3 * i + j] = estimate.P(i, j);
  }
  message.covariance_m2[8] = 1;
  message.yaw_rad = std::remainder(heading_rad + estimate.heading_bias_rad, 2 * std::numbers::pi);
  return message;
}

/// One algorithm in each vehicle.
class OwnOnLand {
 public:
  OwnOnLand(const LandRecord& record, const Algorithm& algorithm, const NavOptions& options, OfflineRun& run)
      : has_radio_(record.has_radio), name_(algorithm.name), room_(payload_room(options.frame_bytes)), run_(run) {
    for (std::size_t i = 0; i < record.land.vehicles.size(); ++i) {
      vehicles_.push_back(algorithm.make());
      vehicles_.back()->start(land_setup(record, static_cast<int>(i), options));
    }
    waiting_.resize(vehicles_.size());
  }

  void predict(int vehicle, Time time, const Vector2& v_W, const Matrix2& q) { at(vehicle).predict(time, v_W, q); }
  void fix(const LandEvent& event, double std_m) { at(event.vehicle).fix(event.time, event.p_W, std_m); }
  bool needs_other(const LandEvent&) const { return !has_radio_; }
  void on_bearing(const LandEvent& event) {
    Relative seen = event.seen;
    Bytes payload;
    if (!has_radio_) {
      payload = make_payload(seen.other, event.time);
      seen.payload_time = event.time;
    } else {
      auto& waiting = waiting_[static_cast<std::size_t>(event.vehicle)];
      const auto newest = waiting.find(seen.other);
      if (newest != waiting.end() && newest->second.time <= event.time) {
        const double age_s = seconds(event.time - newest->second.time);
        if (age_s <= oldest_payload_s) {
          payload = newest->second.payload;
          seen.payload_time = newest->second.time;
          move_back(seen, newest->second.v_W * age_s);
        }
        waiting.erase(newest);
      }
    }
    seen.payload = payload;
    at(event.vehicle).on_bearing(seen);
  }
  void sent(const LandEvent& event) {
    frames_[event.message] = {event.time, at(event.vehicle).now(event.time).v_W,
                              make_payload(event.vehicle, event.time)};
  }
  void received(const LandEvent& event) {
    if (const auto frame = frames_.find(event.message); frame != frames_.end())
      waiting_[static_cast<std::size_t>(event.vehicle)][event.seen.other] = frame->second;
  }
  Estimate now(int vehicle, Time time) { return at(vehicle).now(time); }

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
      throw std::invalid_argument(name_ + " said " + std::to_string(payload.size()) +
                                  " bytes, its frames have room for " + std::to_string(room_));
    ++run_.frames_said;
    run_.payload_bytes[static_cast<std::size_t>(vehicle)] += payload.size();
    return payload;
  }
  /// Refers a relative measurement to where the other vehicle was before it traveled this distance.
  static void move_back(Relative& seen, const Vector2& traveled_W) {
    const Vector2 d_W = seen.range_m * Vector2(std::cos(seen.bearing_rad), std::sin(seen.bearing_rad)) - traveled_W;
    seen.range_m = d_W.norm();
    seen.bearing_rad = std::atan2(d_W.y(), d_W.x());
  }

  bool has_radio_;
  std::string name_;
  std::size_t room_;
  OfflineRun& run_;
  std::vector<std::unique_ptr<Estimator>> vehicles_;
  std::map<std::size_t, Frame> frames_;        ///< by number of the message
  std::vector<std::map<int, Frame>> waiting_;  ///< newest that was received, by vehicle and sender
};

/// One algorithm for the whole team.
class TeamOnLand {
 public:
  TeamOnLand(const LandRecord& record, const Algorithm& algorithm, const NavOptions& options)
      : estimator_(algorithm.make_team()) {
    for (std::size_t i = 0; i < record.land.vehicles.size(); ++i)
      estimator_->start(static_cast<int>(i), land_setup(record, static_cast<int>(i), options));
  }

  void predict(int vehicle, Time time, const Vector2& v_W, const Matrix2& q) {
    estimator_->predict(vehicle, time, v_W, q);
  }
  void fix(const LandEvent& event, double std_m) { estimator_->fix(event.vehicle, event.time, event.p_W, std_m); }
  bool needs_other(const LandEvent&) const { return true; }
  void on_bearing(const LandEvent& event) { estimator_->on_bearing(event.vehicle, event.seen); }
  void sent(const LandEvent&) {}
  void received(const LandEvent&) {}
  Estimate now(int vehicle, Time time) { return estimator_->now(vehicle, time); }

 private:
  std::unique_ptr<TeamEstimator> estimator_;
};

/// Motion of a vehicle up to the present time.
class Walk {
 public:
  explicit Walk(const OdometryTrack& track) : segments_(&track.segments()) {}

  /// Makes the calls of predict() up to a time; with `part` also of the segment that is not complete by then.
  template <class Move>
  void go(Time time, bool part, const Move& move) {
    for (; next_ < segments_->size() && (*segments_)[next_].to <= time; ++next_) call((*segments_)[next_].to, move);
    if (part && next_ < segments_->size()) call(time, move);
  }

 private:
  template <class Move>
  void call(Time time, const Move& move) {
    const OdometryTrack::Segment& segment = (*segments_)[next_];
    if (time <= moved_to_) return;
    move(time, segment.v_W, segment.q);
    moved_to_ = time;
  }

  const std::vector<OdometryTrack::Segment>* segments_;
  std::size_t next_ = 0;
  Time moved_to_ = 0;
};

template <class Run>
void play_on_land(const LandRecord& record, const LandEvents& all, std::int64_t period_us, Run& own, OfflineRun& run) {
  std::vector<Walk> walks(all.tracks.begin(), all.tracks.end());
  const auto walk = [&](int vehicle, Time time, bool part) {
    walks[static_cast<std::size_t>(vehicle)].go(
        time, part, [&](Time to, const Vector2& v_W, const Matrix2& q) { own.predict(vehicle, to, v_W, q); });
  };
  Time tick_us = 0;
  const auto ticks_before = [&](Time time) {
    for (; tick_us < time && tick_us <= record.run.end_us; tick_us += period_us)
      for (std::size_t i = 0; i < walks.size(); ++i) {
        const int vehicle = static_cast<int>(i);
        walk(vehicle, tick_us, false);
        run.estimates[i].push_back({tick_us, land_message(own.now(vehicle, tick_us), tick_us + record.run.epoch_utime,
                                                          all.tracks[i].heading_rad(tick_us))});
      }
  };
  for (const LandEvent& event : all.events) {
    if (event.time < 0) continue;
    ticks_before(event.time);
    walk(event.vehicle, event.time, true);
    switch (event.kind) {
      case LandEvent::Kind::fix:
        own.fix(event, record.land.vehicles[static_cast<std::size_t>(event.vehicle)].fix_std_m);
        break;
      case LandEvent::Kind::bearing:
        if (own.needs_other(event)) walk(event.seen.other, event.time, true);
        own.on_bearing(event);
        ++run.ranges;
        break;
      case LandEvent::Kind::sent:
        own.sent(event);
        break;
      case LandEvent::Kind::received:
        own.received(event);
        break;
    }
  }
  ticks_before(record.run.end_us + 1);
}

}  // namespace

OfflineRun run_on_land(const LandRecord& record, const Algorithm& algorithm, const NavOptions& options,
                       std::int64_t period_us) {
  if (!algorithm.on_land)
    throw std::invalid_argument(algorithm.name +
                                " does not use relative measurements of other vehicles: it does not work on land");
  OfflineRun run;
  run.algorithm = algorithm.name;
  run.estimates.resize(record.land.vehicles.size());
  run.payload_bytes.resize(record.land.vehicles.size());
  run.events = record.items.size();
  const LandEvents events = events_of(record);
  const AlgorithmClock clock(algorithm);
  if (algorithm.make_team) {
    TeamOnLand team(record, algorithm, options);
    play_on_land(record, events, period_us, team, run);
  } else {
    OwnOnLand own(record, algorithm, options, run);
    play_on_land(record, events, period_us, own, run);
  }
  run.cpu_s = clock.elapsed_s();
  return run;
}

}  // namespace navigation
