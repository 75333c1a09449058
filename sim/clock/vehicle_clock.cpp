// SPDX-License-Identifier: BSD-3-Clause
#include "sim/clock/vehicle_clock.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace sim {

namespace {

constexpr Time look_ahead{2'000'000};
constexpr double max_error_s = 4e7;  ///< slightly more than a year
constexpr double max_slew = 0.1;
constexpr double max_learnt = 0.05;

}  // namespace

struct VehicleClock::State {
  /// Node of the oscillator's wander, which is linear between nodes.
  struct Node {
    Time at;
    double wander_s;
  };
  /// Correction that applies after a time, and changes linearly from there.
  struct Steer {
    Time after;
    double offset_s, rate;
  };

  State(const ClockConfig& config_in, std::uint64_t seed, const std::string& vehicle, Time start_in)
      : config(config_in), oscillator(config_in, seed, vehicle + "#clock"), start(start_in), now(start_in) {
    nodes.push_back({start, 0});
  }

  /// Visits the rows as one block, as there are many and the state is hashed often.
  template <typename Row>
  static void visit_block(StateArchive& archive, std::deque<Row>& rows) {
    constexpr std::size_t words = sizeof(Row) / sizeof(std::uint64_t);
    static_assert(std::is_trivially_copyable_v<Row> && sizeof(Row) == words * sizeof(std::uint64_t));
    std::vector<std::uint64_t> block(archive.restoring() ? 0 : words * rows.size());
    if (!archive.restoring())
      for (std::size_t i = 0; i < rows.size(); ++i) std::memcpy(&block[words * i], &rows[i], sizeof(Row));
    archive(block);
    if (!archive.restoring()) return;
    if (block.size() % words != 0) archive.fail("a clock whose history has gaps");
    rows.resize(block.size() / words);
    for (std::size_t i = 0; i < rows.size(); ++i) std::memcpy(&rows[i], &block[words * i], sizeof(Row));
  }

  double wander_s(Time at) const {
    if (nodes.size() == 1 || at <= nodes.front().at) return nodes.front().wander_s;
    auto end = std::upper_bound(nodes.begin(), nodes.end(), at, [](Time t, const Node& node) { return t < node.at; });
    if (end == nodes.end()) --end;  // after the last node, extrapolate the last interval
    const Node& from = *(end - 1);
    const double share = to_seconds(at - from.at) / to_seconds(end->at - from.at);
    return from.wander_s + share * (end->wander_s - from.wander_s);
  }

  const Steer* steer_at(Time at) const {
    for (auto steer = steers.rbegin(); steer != steers.rend(); ++steer)
      if (steer->after < at) return &*steer;
    // Before the history, the oldest correction is a better estimate than none.
    return forgot_steers ? &steers.front() : nullptr;
  }

  double correction_s(Time at) const {
    const Steer* steer = steer_at(at);
    return steer ? steer->offset_s + steer->rate * to_seconds(at - steer->after) : 0;
  }

  double error_s(Time at) const {
    const double free_s = oscillator.offset_s() + oscillator.drift() * to_seconds(at - start) + wander_s(at);
    return std::clamp(free_s + correction_s(at), -max_error_s, max_error_s);
  }

  void discard_old() {
    while (nodes.size() > 2 && nodes[1].at < now - memory) nodes.pop_front();
    while (steers.size() > 1 && steers[1].after < now - memory) {
      steers.pop_front();
      forgot_steers = true;
    }
  }

  ClockConfig config;
  Oscillator oscillator;
  Time start, now;
  std::deque<Node> nodes;
  std::deque<Steer> steers;
  bool forgot_steers = false;
  // State of the control loop of the discipline.
  DisciplineParams loop;
  std::optional<Time> first_fix, last_fix;
  double learnt_rate = 0;      ///< estimate that compensates the oscillator's drift
  double last_measured_s = 0;  ///< residual error after the correction of the last fix
  bool rate_is_unknown = true;
};

VehicleClock::VehicleClock(const ClockConfig& config, std::uint64_t seed, const std::string& vehicle, Time start) {
  if (!config.perfect()) state_ = std::make_unique<State>(config, seed, vehicle, start);
  if (state_) advance_to(start, {});
}

VehicleClock::VehicleClock() = default;
VehicleClock::~VehicleClock() = default;
VehicleClock::VehicleClock(VehicleClock&&) noexcept = default;
VehicleClock& VehicleClock::operator=(VehicleClock&&) noexcept = default;

double VehicleClock::error_s(Time at) const {
  return state_ ? state_->error_s(at) : 0;
}

Time VehicleClock::reading(Time at) const {
  if (!state_) return at;
  const Time shown = at + from_seconds(state_->error_s(at));
  const std::int64_t tick_us = from_seconds(state_->config.resolution_s).count();
  if (tick_us <= 1) return shown;
  const std::int64_t past_us = (shown.count() % tick_us + tick_us) % tick_us;
  return Time{shown.count() - past_us};
}

Time VehicleClock::true_time(Time reading) const {
  if (!state_) return reading;
  // Fixed-point iteration: the error changes by less than half of the time, so that each iteration at least halves the
  // deviation.
  Time at = reading - from_seconds(state_->error_s(reading));
  for (int i = 0; i < 40; ++i) {
    const Time next = reading - from_seconds(state_->error_s(at));
    if (next == at) break;
    at = next;
  }
  return at;
}

double VehicleClock::rate_error(Time now) const {
  if (!state_) return 0;
  constexpr Time later{100'000};
  const State::Steer* steer = state_->steer_at(now + Time{1});
  const double wander_s = state_->wander_s(now + later) - state_->wander_s(now);
  return state_->oscillator.drift() + (steer ? steer->rate : 0) + wander_s / to_seconds(later);
}

bool VehicleClock::wants_temperature(Time now) const {
  return state_ && state_->config.temperature_ppm_per_C != 0 && state_->nodes.back().at <= now + look_ahead;
}

void VehicleClock::advance_to(Time now, std::optional<double> water_temperature_C) {
  if (!state_) return;
  State& state = *state_;
  state.now = now;
  if (!state.config.wanders()) return;
  const Time update = from_seconds(state.config.update_s);
  // Nodes lie ahead of now, so that stamps between two updates are interpolated and never extrapolated.
  while (state.nodes.back().at <= now + look_ahead) {
    state.oscillator.advance(water_temperature_C);
    state.nodes.push_back({state.nodes.back().at + update, state.oscillator.wander_s()});
  }
  state.discard_old();
}

Time VehicleClock::next_advance() const {
  if (!state_ || !state_->config.wanders()) return Time::max();
  const State& state = *state_;
  Time due = state.nodes.back().at - look_ahead;
  const auto expires = [&](Time at) { due = std::min(due, at + memory + Time{1}); };
  if (state.nodes.size() > 2) expires(state.nodes[1].at);
  // A correction that is added later expires later than this.
  expires(state.steers.size() > 1 ? state.steers[1].after : state.now);
  return due;
}

void VehicleClock::advance_time_to(Time now) {
  if (state_) state_->now = now;
}

void VehicleClock::discipline(Time now, double measured_error_s, const DisciplineParams& params) {
  if (!state_) return;
  State& state = *state_;
  state.now = now;
  const double dt_s = params.interval_s;
  state.loop = params;
  // The correction that starts at `now` continues from the end of the previous one.
  const State::Steer* before = state.steer_at(now + Time{1});
  double offset_s = before ? before->offset_s + before->rate * to_seconds(now - before->after) : 0;
  if (!state.first_fix) state.first_fix = now;
  double left_s = measured_error_s;
  // Correct a large error by a step.
  if (std::abs(measured_error_s) > params.step_above_s) {
    offset_s -= measured_error_s;
    left_s = 0;
    state.rate_is_unknown = true;
  }
  // Double pole of the loop: remaining fraction of an error after an interval.
  // From x' = x + dt (d - kp x / dt) and d' = d - ki x / dt of phase x and frequency d: kp = 1 - pole^2, ki = (1 -
  // pole)^2.
  const double pole = std::exp(-dt_s / params.time_constant_s);
  const double kp = 1 - pole * pole;
  const double ki = (1 - pole) * (1 - pole);
  if (left_s != measured_error_s) {
    // After a step the next fix gives the rate.
  } else if (state.rate_is_unknown && state.last_fix && now > *state.last_fix) {
    // Estimate the rate from two fixes when it exceeds the jitter: the loop would need long to learn a drift of many
    // ppm.
    const double rate = (measured_error_s - state.last_measured_s) / to_seconds(now - *state.last_fix);
    if (std::abs(rate) > 5 * std::sqrt(2.0) * params.pps_std_s / dt_s) state.learnt_rate -= rate;
    state.rate_is_unknown = false;
  } else {
    state.learnt_rate -= ki * left_s / dt_s;
  }
  state.learnt_rate = std::clamp(state.learnt_rate, -max_learnt, max_learnt);
  const double slew = std::clamp(-kp * left_s / dt_s, -max_slew, max_slew);
  state.last_measured_s = left_s + slew * dt_s;
  state.last_fix = now;
  // The slew lasts until the next fix; without one, the clock continues with the learnt rate.
  while (!state.steers.empty() && state.steers.back().after >= now) state.steers.pop_back();
  state.steers.push_back({now, offset_s, state.learnt_rate + slew});
  state.steers.push_back({now + from_seconds(dt_s), offset_s + (state.learnt_rate + slew) * dt_s, state.learnt_rate});
  state.discard_old();
}

bool VehicleClock::disciplined(Time now) const {
  return state_ && state_->last_fix && since_fix_s(now) <= 3 * state_->loop.interval_s;
}

double VehicleClock::since_fix_s(Time now) const {
  return state_ && state_->last_fix ? to_seconds(now - *state_->last_fix) : -1;
}

double VehicleClock::estimated_std_s(Time now) const {
  if (!state_) return 0;
  // Variances of the free-running oscillator.
  const ClockConfig& c = state_->config;
  const double white = c.white_fm * c.white_fm, walk = c.random_walk_fm * c.random_walk_fm;
  const double floor = c.flicker_floor * c.flicker_floor;
  double t_s = to_seconds(now - state_->start);
  double phase = c.offset_std_s * c.offset_std_s;
  double rate = std::pow(1e-6 * c.drift_std_ppm, 2) +
                static_cast<double>(flicker_times_s().size()) * std::pow(flicker_process_std(), 2) * floor;
  if (state_->last_fix) {
    t_s = since_fix_s(now);
    const double tau_s = state_->loop.time_constant_s;
    const double pps = state_->loop.pps_std_s * state_->loop.pps_std_s;
    const double jitter = pps * state_->loop.interval_s;
    // Responses of the critically damped loop to white noise of the pulse, and to noise of the oscillator's frequency.
    phase = 5 * jitter / (4 * tau_s) + white * tau_s / 4 + walk * std::pow(tau_s, 3) / 4 + floor * tau_s * tau_s;
    // Variance of the drift from the first two fixes, or from the data sheet, and its remainder after the loop.
    const double reported =
        state_->rate_is_unknown ? rate : std::min(rate, 50 * pps / std::pow(state_->loop.interval_s, 2));
    const double times = to_seconds(*state_->last_fix - *state_->first_fix) / tau_s;
    const double left = (1 + times) * std::exp(-times);
    rate = reported * left * left + jitter / (4 * std::pow(tau_s, 3)) + white / (4 * tau_s) + 5 * tau_s * walk / 4 +
           2.5 * floor;
  }
  return std::sqrt(phase + rate * t_s * t_s + white * t_s + walk * std::pow(t_s, 3) / 3);
}

void VehicleClock::visit_state(StateArchive& archive) {
  if (!state_) return;
  State& s = *state_;
  // Oscillator, history and loop.
  archive(s.oscillator, s.now);
  State::visit_block(archive, s.nodes);
  State::visit_block(archive, s.steers);
  archive(s.forgot_steers, s.first_fix, s.last_fix);
  archive(s.loop.time_constant_s, s.loop.step_above_s, s.loop.pps_std_s, s.loop.interval_s);
  archive(s.learnt_rate, s.last_measured_s, s.rate_is_unknown, s.start);
  if (archive.restoring() && (s.nodes.empty() || (s.forgot_steers && s.steers.empty())))
    archive.fail("a clock without its history");
  if (!archive.restoring()) return;
  // Check the restored history.
  const auto usable = [](Time at, double number) {
    return at <= StateArchive::max_time && at >= -StateArchive::max_time && std::abs(number) < 1e30;
  };
  const bool nodes_fit =
      std::all_of(s.nodes.begin(), s.nodes.end(), [&](const State::Node& n) { return usable(n.at, n.wander_s); });
  const bool steers_fit = std::all_of(s.steers.begin(), s.steers.end(), [&](const State::Steer& steer) {
    return usable(steer.after, steer.offset_s) && std::abs(steer.rate) < 1e30;
  });
  if (!nodes_fit || !steers_fit) archive.fail("the snapshot has an invalid clock error");
  const bool in_order = std::is_sorted(s.nodes.begin(), s.nodes.end(),
                                       [](const State::Node& a, const State::Node& b) { return a.at < b.at; });
  if (s.now < Time{0} || !in_order || (s.config.wanders() && s.nodes.back().at <= s.now + look_ahead))
    archive.fail("a clock whose time does not match its history");
}

bool VehicleClock::is_stopped_at(Time now) const {
  return !state_ || state_->now == now;
}

}  // namespace sim
