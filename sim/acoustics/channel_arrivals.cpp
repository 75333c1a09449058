// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/acoustics/channel.hpp"
#include "sim/acoustics/sound_path.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/device/fault.hpp"

// Reception of signals at their receivers.

namespace sim {

namespace {

/// Gains below this count as zero.
constexpr double lowest_dB = -1000;

}  // namespace

PowerRatio AcousticChannel::noise_at(const Transducer& to, const Vector3d& p_W, const Signal& signal) const {
  PowerRatio noise =
      propagation_.ambient_power(signal.centre_Hz, signal.bandwidth_Hz, to.noise_reduction(signal.centre_Hz));
  for (const ContinuousSound* sound : sounds_) {
    if (!sound->on_ || !sound->site_.powered || sound->site_.faults.silent()) continue;
    const Vector3d from_W = sound->site_.body.X_WB() * sound->site_.X_BS.translation();
    if (!around_.medium.in_water(from_W)) continue;
    const double f = sound->center_Hz_, half_Hz = sound->bandwidth_Hz_ / 2;
    const double low_Hz = std::max(f - half_Hz, signal.centre_Hz - signal.bandwidth_Hz / 2);
    const double high_Hz = std::min(f + half_Hz, signal.centre_Hz + signal.bandwidth_Hz / 2);
    if (high_Hz <= low_Hz) continue;
    Decibels level = sound->source_level_ - propagation_.transmission_loss(from_W, p_W, f);
    level += directivity_gain(to.config().directivity, to.R_WS().transpose() * (from_W - p_W), f,
                              around_.medium.sound_speed_mps(p_W));
    if (config_.occlusion)
      level += pressure_level(propagation_.free_part(from_W, sound->site_.group, p_W, to.group(), signal.centre_Hz));
    noise += (high_Hz - low_Hz) / sound->bandwidth_Hz_ * to_power(level);
  }
  return noise;
}

Decibels AcousticChannel::link_loss(const Transducer& to, const Sending& sending, double& loss_probability) const {
  // Whether a name of the configuration, a vehicle or a device, includes a device.
  const auto named = [](const std::string& name, const std::string& device) {
    return name.empty() || name == device ||
           (device.size() > name.size() && device[name.size()] == '/' && device.compare(0, name.size(), name) == 0);
  };
  // Sum of losses, and probability of any of the random losses.
  Decibels loss{0};
  loss_probability = 0;
  for (const LinkConfig& link : config_.links) {
    const bool there = named(link.from, sending.source) && named(link.to, to.full_name());
    const bool back = link.both_ways && named(link.to, sending.source) && named(link.from, to.full_name());
    if (!there && !back) continue;
    loss = loss + Decibels{link.extra_loss_dB};
    loss_probability = 1 - (1 - loss_probability) * (1 - link.loss_probability);
  }
  return loss;
}

Random AcousticChannel::stream(const Transducer& to, const Sending& sending, bool at_end) const {
  // One stream per pair, so that adding a modem changes no other link.
  Random random(around_.seed, sending.source + ">" + to.full_name() + "#sound");
  random.begin_step(2 * sending.sequence + at_end);
  return random;
}

AcousticChannel::Level AcousticChannel::level_at(const Transducer& to, const Vector3d& p_W, const Flight& flight,
                                                 const Sending& sending) const {
  Level at;
  const Signal& signal = sending.signal;
  // Path gain.
  Random random = propagation_.draws() ? stream(to, sending, false) : Random(0, {});
  Propagation::Gain gain = propagation_.gain(sending.p_W, sending.group, p_W, to.group(), signal.centre_Hz, random);
  // Directions of the sound at both ends: those of its ray, or of the straight line.
  const Vector3d displacement_W = p_W - sending.p_W;
  const double range_m = displacement_W.norm();
  const Vector3d direction_W = range_m > 0 ? Vector3d(displacement_W / range_m) : Vector3d(Vector3d::UnitX());
  const Vector3d leaves_W = gain.first ? gain.first->leaves_W : direction_W;
  const Vector3d arrives_W = gain.first ? gain.first->arrives_W : direction_W;
  at.bent = gain.first.has_value();
  at.shadow = gain.first && gain.first->shadow;
  at.arrives_W = arrives_W;
  // Doppler and end of the signal.
  const Vector3d v_to_W = to.v_W();
  const double c = around_.medium.sound_speed_mps(p_W);
  double squeezed;
  if (at.bent) {
    at.closing_mps = leaves_W.dot(sending.v_W) - arrives_W.dot(v_to_W);
    const double c_from = around_.medium.sound_speed_mps(sending.p_W);
    squeezed = (1 - arrives_W.dot(v_to_W) / c) / (1 - leaves_W.dot(sending.v_W) / c_from);
  } else {
    at.closing_mps = closing_speed_mps(direction_W, sending.v_W, v_to_W);
    squeezed = doppler_factor(direction_W, sending.v_W, v_to_W, c);
  }
  at.ended = flight.started + from_seconds(to_seconds(signal.duration) / squeezed);

  // Losses of the link.
  double loss_probability = 0;
  Decibels level = signal.source_level - link_loss(to, sending, loss_probability);
  // Directivity at both ends.
  const auto add_beam = [&](const DirectivityConfig& beam, const auto& direction_S) {
    if (beam.pattern != DirectivityConfig::Pattern::omni)
      level += directivity_gain(beam, direction_S(), signal.centre_Hz, c);
  };
  add_beam(sending.directivity, [&] { return Vector3d(sending.R_WS.transpose() * leaves_W); });
  add_beam(to.config().directivity, [&] { return Vector3d(-(to.R_WS().transpose() * arrives_W)); });
  at.level = level + gain.signal;
  at.later_s = gain.later_s;
  at.echoes = std::move(gain.echoes);
  at.blocked = gain.blocked && gain.signal.dB() < lowest_dB;
  if (gain.disturbing.linear() > 0) at.disturbing = to_power(level) * gain.disturbing;
  return at;
}

SignalLoss AcousticChannel::obstacle(const Flight& flight) const {
  const Transducer& to = *receiver_of(flight);
  if (!around_.medium.in_water(flight.p_started_W)) return SignalLoss::out_of_water;
  if (!to.works()) return SignalLoss::receiver_off;
  if (flight.loss != SignalLoss::none) return flight.loss;  // blocked
  // SignalReceiver::take() tests this too; but an undetectable signal counts as lost in noise whatever the causes
  // below.
  if (flight.snr < Decibels{to.config().detection_dB}) return flight.shadow ? SignalLoss::shadow : SignalLoss::noise;
  if (flight.started < to.sending_until_) return SignalLoss::half_duplex;
  if (std::abs(flight.closing_mps) > to.config().doppler_limit_mps) return SignalLoss::doppler;
  return SignalLoss::none;
}

void AcousticChannel::lock(Flight& flight, const Sending& sending,
                           const std::vector<Propagation::Gain::Echo>& echoes) const {
  const Transducer& to = *receiver_of(flight);
  const EchoLockConfig& config = *config_.echo_lock;
  const double over_dB = std::max(0.0, flight.snr.dB() - to.config().detection_dB);
  const double at_most = config.probability * std::exp(-over_dB / config.margin_dB);
  Random random(around_.seed, sending.source + ">" + to.full_name() + "#echo");
  random.begin_step(sending.sequence);
  for (const Propagation::Gain::Echo& echo : echoes) {
    const double luck = random.uniform();
    // Nearer than the resolution of the signal an echo is part of the first arrival.
    if (echo.later_s * sending.signal.bandwidth_Hz < 1 || luck >= at_most * std::min(1.0, echo.relative.linear()))
      continue;
    flight.lock_later_s = echo.later_s;
    flight.arrives_W = echo.arrives_W;
    flight.bent = true;
    return;
  }
}

void AcousticChannel::begin(int number, Consequences& out) {
  Flight& flight = flights_[static_cast<std::size_t>(number)];
  const Sending& sending = *sendings_[static_cast<std::size_t>(flight.sending)];
  Transducer* const receiver = receiver_of(flight);
  if (receiver == nullptr) {
    end_quietly(number, out);
    return;
  }
  Transducer& to = *receiver;
  const Vector3d p_W = to.p_W(flight.started);
  // The position is as predicted except for rotation in this short time; after a jump of the transducer, predict the
  // arrival again.
  if (!flight.delayed && (p_W - flight.p_started_W).norm() > 0.01) {
    approach(number, flight.started, out);
    return;
  }
  flight.p_started_W = p_W;
  // Drop signals beyond the maximum range.
  if (config_.range_max_m && (p_W - sending.p_W).norm() > *config_.range_max_m) {
    if (flight.meant) ++to.counts_.lost[static_cast<std::size_t>(SignalLoss::range)];
    flight.loss = SignalLoss::range;
    end_quietly(number, out);
    return;
  }
  const Level found = level_at(to, p_W, flight, sending);
  flight.level = found.level;
  flight.ended = found.ended;
  flight.closing_mps = found.closing_mps;
  flight.bent = found.bent;
  flight.shadow = found.shadow;
  flight.arrives_W = found.arrives_W;
  if (found.blocked) flight.loss = SignalLoss::blocked;
  if (found.later_s > 0 && !flight.delayed) {
    // The direct path is blocked: the first arrival is an echo.
    flight.delayed = true;
    flight.travel_time_s += found.later_s;
    flight.started += from_seconds(found.later_s);
    update_hash(number, out.sum);
    out.schedule(flight.started, start_event);
    return;
  }
  // Start the reception.
  flight.listened = to.listener_.listens_to(sending.signal);
  flight.present = flight.loss == SignalLoss::none && around_.medium.in_water(flight.p_started_W);
  const PowerRatio power = to_power(flight.level);
  if (flight.present)
    to.receiver_.begin({number, sending.signal.centre_Hz, sending.signal.bandwidth_Hz, power + found.disturbing,
                        flight.ended, sending.signal.kind == Signal::Kind::message},
                       flight.started);
  if (flight.listened) take(number, flight, sending, power, found.disturbing, out);
  if (flight.detected && !found.echoes.empty()) lock(flight, sending, found.echoes);
  update_hash(number, out.sum);
  out.schedule(flight.ended, end_event);
  if (!flight.present || sending.cut == SignalLoss::none) return;
  if (const auto from = silent_from(number, sending, flight.started)) out.schedule(*from, silence_event);
}

void AcousticChannel::fall_silent(int number, Time due) {
  const Flight& flight = flights_[static_cast<std::size_t>(number)];
  Transducer* const to = receiver_of(flight);
  if (to != nullptr && flight.present) to->receiver_.silence(number, due);
}

void AcousticChannel::take(int number, Flight& flight, const Sending& sending, PowerRatio power, PowerRatio disturbing,
                           Consequences& out) {
  const Signal& signal = sending.signal;
  Transducer& to = *receiver_of(flight);
  TakenSignal taken;
  taken.sound = {number, signal.centre_Hz, signal.bandwidth_Hz, power, flight.ended};
  taken.noise = noise_at(to, flight.p_started_W, signal);
  taken.disturbing = disturbing;
  taken.modulation = signal.modulation;
  taken.bit_rate_bps = signal.bit_rate_bps;
  taken.bits = signal.bits;
  taken.coding_gain_dB = signal.coding_gain_dB;
  taken.protection = to_power(Decibels{to.config().protection_dB});
  taken.started = flight.started;
  taken.ended = flight.ended;
  flight.snr = to_decibels(taken.sound.power / (taken.noise + disturbing));
  flight.loss = obstacle(flight);
  if (flight.loss != SignalLoss::none) return;
  std::int64_t displaced = -1;
  flight.loss = to.receiver_.take(taken, {to.config().detection_dB, to.config().capture_dB}, displaced);
  flight.detected = flight.loss == SignalLoss::none;
  if (displaced < 0) return;
  flights_[static_cast<std::size_t>(displaced)].loss = SignalLoss::captured;
  update_hash(static_cast<int>(displaced), out.sum);
}

void AcousticChannel::finish(const Transducer& to, Flight& flight, const Sending& sending,
                             const SignalReceiver::Outcome& outcome) {
  Random random = stream(to, sending, true);
  const double luck = random.uniform();
  const double link_luck = random.uniform();
  if (luck > outcome.success) flight.loss = luck > outcome.success_alone ? SignalLoss::noise : SignalLoss::interference;
  double loss_probability = 0;
  link_loss(to, sending, loss_probability);
  if (flight.loss == SignalLoss::none && link_luck < loss_probability) flight.loss = SignalLoss::link;
}

Decibels AcousticChannel::end_at(Transducer& to, int number) {
  Flight& flight = flights_[static_cast<std::size_t>(number)];
  const Sending& sending = *sendings_[static_cast<std::size_t>(flight.sending)];
  // Determine the result of the reception.
  SignalReceiver::Outcome outcome;
  const bool taken = flight.present && to.receiver_.end(number, flight.ended, outcome);
  if (!flight.listened) return flight.snr;
  if (taken) {
    finish(to, flight, sending, outcome);
    if (sending.cut != SignalLoss::none) flight.loss = sending.cut;
    if (!around_.medium.in_water(to.p_W(flight.ended))) flight.loss = SignalLoss::out_of_water;
    if (!to.works()) flight.loss = SignalLoss::receiver_off;
  }
  // Count messages addressed to the receiver.
  if (flight.meant) ++to.counts_.lost[static_cast<std::size_t>(flight.loss)];
  if (flight.meant && flight.loss == SignalLoss::none) {
    ++to.counts_.understood;
    to.counts_.understood_bytes += static_cast<std::int64_t>(sending.signal.payload.size());
  }
  return taken ? to_decibels(outcome.worst_sinr) : flight.snr;
}

void AcousticChannel::end_quietly(int number, Consequences& out) {
  if (Transducer* const to = receiver_of(flights_[static_cast<std::size_t>(number)])) end_at(*to, number);
  out.ended = true;
}

void AcousticChannel::end(int number) {
  if (Transducer* const to = receiver_of(flights_[static_cast<std::size_t>(number)])) {
    const Decibels sinr = end_at(*to, number);
    conclude(number);
    const Flight& flight = flights_[static_cast<std::size_t>(number)];
    if (flight.listened && (flight.detected || to->listener_.wants_undetected()))
      notify(*to, flight, *sendings_[static_cast<std::size_t>(flight.sending)], sinr);
  }
  discard(number);
}

/// Notifies the listener unless the receiver itself cannot receive: the end of a signal is received when only the
/// sender left the water.
void AcousticChannel::notify(Transducer& to, const Flight& flight, const Sending& sending, Decibels sinr) {
  const bool out_itself = flight.loss == SignalLoss::out_of_water && sending.cut != SignalLoss::out_of_water;
  const bool deaf = out_itself || flight.loss == SignalLoss::receiver_off || flight.loss == SignalLoss::blocked ||
                    !to.works() || !around_.medium.in_water(to.p_W(flight.ended));
  if (deaf) return;
  const Vector3d back_W = sending.p_W - flight.p_started_W;
  const Vector3d apparent_W = flight.bent ? Vector3d(-back_W.norm() * flight.arrives_W) : back_W;
  const Time started = flight.started + from_seconds(flight.lock_later_s);
  to.listener_.receive({sending.signal, sending.source, sending.number, sending.sent, started, flight.ended,
                        flight.travel_time_s + flight.lock_later_s, sending.p_W, flight.p_started_W, apparent_W,
                        flight.level, flight.snr, sinr, flight.closing_mps, flight.loss, flight.detected});
}

void AcousticChannel::conclude(int number) {
  const Flight& flight = flights_[static_cast<std::size_t>(number)];
  const Transducer* const to = receiver_of(flight);
  const bool beyond = flight.loss == SignalLoss::range && flight.meant;
  if (to == nullptr || !(flight.listened || beyond)) return;
  const Sending& sending = *sendings_[static_cast<std::size_t>(flight.sending)];
  if (flight.meant && flight.loss == SignalLoss::shadow && shadow_losses_.size() < max_shadow_losses)
    shadow_losses_.push_back(
        {sending.sent, sending.source, to->full_name(), (flight.p_started_W - sending.p_W).norm()});
  if (observer_ != nullptr) report_arrival(flight, sending, *to);
}

void AcousticChannel::discard(int number) {
  // A listener may have transmitted, which invalidates references.
  Flight& flight = flights_[static_cast<std::size_t>(number)];
  const int of = flight.sending;
  flights_sum_ -= flight.hash;
  free_flights_.push_back(number);
  flight = {};
  release(of);
}

void AcousticChannel::report_sent(const Sending& sending) const {
  observer_->sound_sent({sending.signal, sending.source, sending.sequence, sending.sent, sending.p_W,
                         around_.medium.sound_speed_mps(sending.p_W)});
}

void AcousticChannel::report_beyond_range(const Sending& sending, double reach_m) const {
  if (sending.signal.kind != Signal::Kind::message) return;
  for (const Transducer* to : transducers_) {
    if (to == nullptr || to == sending.from || !to->is_meant_by(sending.signal)) continue;
    const Vector3d p_W = to->p_W(sending.sent);
    if ((p_W - sending.p_W).norm() <= reach_m) continue;
    observer_->sound_arrived({sending.source, sending.sequence, to->full_name(), true, sending.sent, sending.sent, 0,
                              p_W, 0, SignalLoss::range});
  }
}

void AcousticChannel::report_arrival(const Flight& flight, const Sending& sending, const Transducer& to) const {
  observer_->sound_arrived({sending.source, sending.sequence, to.full_name(), flight.meant, flight.started,
                            flight.ended, flight.travel_time_s, flight.p_started_W, flight.snr.dB(), flight.loss});
}

// Events that threads handle together, receiver by receiver.  What an event changes outside of its receiver and its
// flight is carried out afterwards, in the order of the events.

bool AcousticChannel::defer(const Event& event, Time now) {
  const bool arrives = event.kind == near_event || event.kind == start_event;
  if (!arrives && event.kind != end_event) return false;
  fetch_ahead();
  const int number = static_cast<int>(event.stamp.count());
  const Flight& flight = flights_[static_cast<std::size_t>(number)];
  if (arrives) {
    // The end of a short signal may be due in this step, and change more than its receiver.
    if (sendings_[static_cast<std::size_t>(flight.sending)]->signal.duration <= 2 * (now - event.due)) return false;
  } else if (flight.listened) {
    const Transducer* const to = receiver_of(flight);
    if (to != nullptr && (flight.detected || to->listener_.wants_undetected())) return false;
  }
  // Append to the events at the same receiver.
  deferred_at_.resize(std::max(deferred_at_.size(), transducers_.size() + 1), {-1, -1});
  const std::size_t at = flight.to < 0 ? transducers_.size() : static_cast<std::size_t>(flight.to);
  const auto added = static_cast<int>(deferred_.size());
  auto& [first, last] = deferred_at_[at];
  if (first < 0) {
    first = added;
    receivers_.push_back(at);
  } else {
    deferred_[static_cast<std::size_t>(last)].next = added;
  }
  last = added;
  deferred_.push_back({event.due, static_cast<EventKind>(event.kind), number, -1, {}});
  return true;
}

bool AcousticChannel::handle_deferred(Time until, Time now, ThreadPool* threads) {
  if (deferred_.empty()) return false;
  begin_handling(now);
  deferred_events_ += static_cast<std::int64_t>(deferred_.size());
  const Scene& scene = around_.physics.scene();
  if (config_.occlusion || config_.multipath || propagation_.bends()) scene.prepare();
  for_each_block(scene.concurrent() ? threads : nullptr, receivers_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) handle_at_receiver(deferred_at_[receivers_[i]][0], until);
  });
  for (const Deferred& each : deferred_) carry_out(each.flight, each.consequences);
  for (const std::size_t at : receivers_) deferred_at_[at] = {-1, -1};
  receivers_.clear();
  deferred_.clear();
  handling_ = false;
  return true;
}

/// Handles the deferred events at a receiver, `first` and those after it, and the starts before `until` that follow.
void AcousticChannel::handle_at_receiver(int first, Time until) {
  struct Start {
    Time at;
    Deferred* of;
  };
  std::vector<Start> starts;  // by time
  std::size_t next_start = 0;
  for (int next = first; next >= 0 || next_start < starts.size();) {
    // Take the earlier one; at the same time, that which was scheduled earlier.
    Deferred* const listed = next >= 0 ? &deferred_[static_cast<std::size_t>(next)] : nullptr;
    const bool starts_now = listed == nullptr || (next_start < starts.size() && starts[next_start].at < listed->due);
    Deferred& each = starts_now ? *starts[next_start].of : *listed;
    Consequences& out = each.consequences;
    if (starts_now) {
      const Time at = starts[next_start++].at;
      handle_at_receiver(each.flight, start_event, at, out);
    } else {
      next = each.next;
      handle_at_receiver(each.flight, each.kind, each.due, out);
    }
    // Keep a start that is due before `until`.
    if (out.count != 1 || out.events[0].kind != start_event || out.events[0].at >= until) continue;
    out.count = 0;
    const Time at = out.events[0].at;
    const auto later = std::upper_bound(starts.begin() + static_cast<std::ptrdiff_t>(next_start), starts.end(), at,
                                        [](Time time, const Start& start) { return time < start.at; });
    starts.insert(later, {at, &each});
  }
}

void AcousticChannel::handle_at_receiver(int flight, EventKind kind, Time due, Consequences& out) {
  if (kind == near_event) approach(flight, due, out);
  if (kind == start_event) begin(flight, out);
  if (kind == end_event) end_quietly(flight, out);
}

void AcousticChannel::carry_out(int flight, const Consequences& consequences) {
  flights_sum_ += consequences.sum;
  for (int i = 0; i < consequences.count; ++i) {
    const Consequences::Due& event = consequences.events[static_cast<std::size_t>(i)];
    schedule(event.at, event.kind, flight);
  }
  if (!consequences.ended) return;
  conclude(flight);
  discard(flight);
}

}  // namespace sim
