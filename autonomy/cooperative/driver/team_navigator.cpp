// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/team_navigator.hpp"

#include <algorithm>

namespace navigation {

void TeamNavigator::start(int vehicle, const Setup& setup) {
  calls_.push_back(
      {.kind = Call::Kind::start, .vehicle = vehicle, .time = setup.time, .order = setup.time, .setup = setup});
}

void TeamNavigator::add(int vehicle, const NavEvent& event) {
  Time order = event.time;
  if (event.kind == NavEvent::Kind::received) order = std::max(order, event.received.payload_time + 1);
  calls_.push_back({.vehicle = vehicle, .time = event.time, .order = order, .event = event});
}

void TeamNavigator::sent(int vehicle, Time time, Time frame_time) {
  // The time of a frame is in milliseconds.
  calls_.push_back({.kind = Call::Kind::sent,
                    .vehicle = vehicle,
                    .time = time,
                    .order = time,
                    .frame_time = frame_time / 1000 * 1000});
}

void TeamNavigator::query(int vehicle, Time time, std::function<void(const Estimate&)> answer) {
  calls_.push_back(
      {.kind = Call::Kind::query, .vehicle = vehicle, .time = time, .order = time, .answer = std::move(answer)});
}

void TeamNavigator::run(TeamEstimator& estimator) {
  std::stable_sort(calls_.begin(), calls_.end(), [](const Call& a, const Call& b) { return a.order < b.order; });
  // The motion of each vehicle that follows a call, from the end back; at the end that before.
  std::vector<const NavEvent*> motion(vehicles_, nullptr);
  const auto is_motion = [](const Call& call) {
    return call.kind == Call::Kind::event && call.event.kind == NavEvent::Kind::motion;
  };
  for (const Call& call : calls_)
    if (is_motion(call)) motion[static_cast<std::size_t>(call.vehicle)] = &call.event;
  const auto is_sight = [](const Call& call) {
    return call.kind == Call::Kind::event && call.event.kind == NavEvent::Kind::bearing;
  };
  std::vector<const NavEvent*> next(calls_.size()), next_of_seen(calls_.size(), nullptr);
  for (std::size_t i = calls_.size(); i-- > 0;) {
    const NavEvent*& own = motion[static_cast<std::size_t>(calls_[i].vehicle)];
    if (is_motion(calls_[i])) own = &calls_[i].event;
    next[i] = own;
    if (is_sight(calls_[i])) next_of_seen[i] = motion[static_cast<std::size_t>(calls_[i].event.seen.other)];
  }
  std::vector<Time> moved_to(vehicles_, 0);
  std::vector<bool> started(vehicles_, false);
  for (std::size_t i = 0; i < calls_.size(); ++i) {
    const Call& each = calls_[i];
    const auto vehicle = static_cast<std::size_t>(each.vehicle);
    if (each.kind == Call::Kind::start) {
      estimator.start(each.vehicle, each.setup);
      started[vehicle] = true;
      moved_to[vehicle] = each.time;
      continue;
    }
    if (!started[vehicle]) continue;
    const auto move = [&](int moving, const NavEvent* by) {
      Time& to = moved_to[static_cast<std::size_t>(moving)];
      if (by == nullptr || !started[static_cast<std::size_t>(moving)] || each.time <= to) return;
      estimator.predict(moving, each.time, by->v_W, by->q);
      to = each.time;
    };
    if (each.kind != Call::Kind::query) move(each.vehicle, next[i]);
    if (is_sight(each)) move(each.event.seen.other, next_of_seen[i]);
    call(each, estimator);
  }
  calls_.clear();
}

void TeamNavigator::call(const Call& each, TeamEstimator& estimator) {
  switch (each.kind) {
    case Call::Kind::start:
      break;
    case Call::Kind::sent:
      estimator.sent(each.vehicle, each.frame_time);
      break;
    case Call::Kind::query:
      each.answer(estimator.now(each.vehicle, each.time));
      break;
    case Call::Kind::event:
      switch (each.event.kind) {
        case NavEvent::Kind::motion:
        case NavEvent::Kind::payload:
          break;
        case NavEvent::Kind::fix:
          estimator.fix(each.vehicle, each.time, each.event.p_W, each.event.std_m);
          break;
        case NavEvent::Kind::received:
          estimator.on_range(each.vehicle, each.event.received);
          break;
        case NavEvent::Kind::bearing:
          estimator.on_bearing(each.vehicle, each.event.seen);
          break;
      }
  }
}

}  // namespace navigation
