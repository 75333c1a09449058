// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/navigator.hpp"

#include <algorithm>

namespace navigation {

namespace {

OwnedEstimator started(const Algorithm& algorithm, const Setup& setup) {
  OwnedEstimator estimator(algorithm.make());
  estimator->start(setup);
  return estimator;
}

}  // namespace

Navigator::Navigator(const Algorithm& algorithm, const Setup& setup)
    : settled_(started(algorithm, setup)), ahead_(settled_), settled_to_(setup.time), ahead_to_(setup.time) {}

bool Navigator::add(NavEvent event) {
  if (event.time < settled_to_) {
    ++dropped_;
    return false;
  }
  // After all events of the same time.
  const auto place = std::upper_bound(recent_.begin(), recent_.end(), event.time,
                                      [](Time time, const NavEvent& each) { return time < each.time; });
  const auto index = static_cast<std::size_t>(place - recent_.begin());
  recent_.insert(place, std::move(event));
  if (index < applied_) {
    ahead_ = settled_;
    ahead_to_ = settled_to_;
    applied_ = 0;
  }
  settle();
  return true;
}

void Navigator::settle() {
  while (seconds(recent_.back().time - recent_.front().time) > window_s) {
    if (applied_ == 0) catch_up();
    apply(settled_, 0, settled_to_);
    if (recent_.front().kind == NavEvent::Kind::motion) last_moved_ = recent_.front();
    recent_.pop_front();
    --applied_;
  }
}

void Navigator::catch_up() {
  for (; applied_ < recent_.size(); ++applied_) apply(ahead_, applied_, ahead_to_);
}

void Navigator::apply(OwnedEstimator& estimator, std::size_t index, Time& moved_to, Bytes* payload) const {
  using Kind = NavEvent::Kind;
  const NavEvent& event = recent_[index];
  if (event.time > moved_to) {
    // The motion until then is that of the report which follows, or of the last one.
    const auto next = std::find_if(recent_.begin() + static_cast<std::ptrdiff_t>(index), recent_.end(),
                                   [](const NavEvent& each) { return each.kind == Kind::motion; });
    const NavEvent* moved = next != recent_.end() ? &*next : nullptr;
    for (std::size_t before = index; moved == nullptr && before > 0; --before)
      if (recent_[before - 1].kind == Kind::motion) moved = &recent_[before - 1];
    if (moved == nullptr) moved = &last_moved_;
    estimator->predict(event.time, moved->v_W, moved->q);
    moved_to = event.time;
  }
  switch (event.kind) {
    case Kind::motion:
      break;
    case Kind::fix:
      estimator->fix(event.time, event.p_W, event.std_m);
      break;
    case Kind::received: {
      ReceivedRange received = event.received;
      received.payload = event.payload;
      estimator->on_range(received);
      break;
    }
    case Kind::bearing: {
      Relative seen = event.seen;
      seen.payload = event.payload;
      estimator->on_bearing(seen);
      break;
    }
    case Kind::payload: {
      Bytes answer = estimator->make_payload(event.time, event.max_bytes);
      if (payload != nullptr) *payload = std::move(answer);
      break;
    }
  }
}

Bytes Navigator::make_payload(Time time, std::size_t max_bytes) {
  NavEvent event;
  event.kind = NavEvent::Kind::payload;
  event.time = time;
  event.max_bytes = max_bytes;
  if (!add(std::move(event))) return {};
  // All events before it, and then itself: none is later.
  Bytes payload;
  while (applied_ + 1 < recent_.size()) apply(ahead_, applied_++, ahead_to_);
  if (recent_.back().kind == NavEvent::Kind::payload && recent_.back().time == time) {
    apply(ahead_, applied_, ahead_to_, &payload);
    ++applied_;
  }
  return payload;
}

Estimate Navigator::now(Time time) {
  catch_up();
  return ahead_->now(time);
}

}  // namespace navigation
