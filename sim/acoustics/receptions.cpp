// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/receptions.hpp"

#include <algorithm>
#include <cmath>

#include "sim/device/fault.hpp"

namespace sim {

namespace {

void set_level(Flight& flight, const SonarEquation::Level& found) {
  flight.level = found.level;
  flight.ended = found.ended;
  flight.closing_mps = found.closing_mps;
  flight.bent = found.bent;
  flight.shadow = found.shadow;
  flight.arrives_W = found.arrives_W;
  if (found.blocked) flight.loss = SignalLoss::blocked;
}

}  // namespace

void Receptions::handle(FlightId id, AcousticEvent kind, Time due, ArrivalEffects& effects) {
  if (kind == AcousticEvent::near) predict(id, due, effects);
  if (kind == AcousticEvent::start) start(id, effects);
  if (kind == AcousticEvent::end) {
    if (Transducer* const to = flights_.receiver(id)) end(id, *to);
    effects.ended = true;
  }
}

/// Corrects the arrival along the straight line to that of the first ray: Newton's method on the travel time, whose
/// derivative by the position of the receiver is the direction of the sound over its speed.
void Receptions::follow_ray(Arrival& arrival, const Transmission& transmission, const Vector3d& velocity_W) const {
  for (int round = 0; round < 4; ++round) {
    const Propagation::First first =
        sonar_.propagation().first_arrival(transmission.p_W, arrival.p_W, transmission.signal.centre_Hz);
    const double c_mps = medium_.sound_speed_mps(arrival.p_W);
    const double change_s =
        (first.travel_time_s - arrival.travel_time_s) / (1 - first.arrives_W.dot(velocity_W) / c_mps);
    arrival.travel_time_s += change_s;
    arrival.p_W += velocity_W * change_s;
    // The remaining error is of second order: nanoseconds at most.
    if (std::abs(change_s) < 2e-3) return;
  }
}

std::optional<Arrival> Receptions::arrival_at(const Transducer& to, const Transmission& transmission) const {
  const Time now = clock_.step_end();
  auto arrival = meeting(medium_, transmission.p_W, transmission.sent, to.p_W(now), now, to.v_W());
  if (arrival && sonar_.propagation().bends()) follow_ray(*arrival, transmission, to.v_W());
  return arrival;
}

void Receptions::predict(FlightId id, Time due, ArrivalEffects& effects) {
  Flight& flight = flights_[id];
  if (const Transducer* const to = flights_.receiver(flight)) {
    const Transmission& transmission = transmissions_[flight.transmission];
    const std::optional<Arrival> arrival = arrival_at(*to, transmission);
    if (arrival) {
      flight.travel_time_s = arrival->travel_time_s;
      flight.started = std::max(due, transmission.sent + from_seconds(arrival->travel_time_s));
      flight.p_started_W = to->p_W(flight.started);
    } else {
      flight.set_receiver(nullptr);  // faster than sound: the body has diverged
    }
  }
  flights_.update_hash(id, effects.sum);
  effects.schedule(std::max(flight.started, due), AcousticEvent::start);
}

void Receptions::start(FlightId id, ArrivalEffects& effects) {
  Flight& flight = flights_[id];
  Transducer* const receiver = flights_.receiver(flight);
  if (receiver == nullptr) {
    effects.ended = true;
    return;
  }
  Transducer& to = *receiver;
  const Transmission& transmission = transmissions_[flight.transmission];
  const Vector3d p_W = to.p_W(flight.started);
  // The position is as predicted except for rotation in this short time; after a jump of the transducer, predict the
  // arrival again.
  if (!flight.delayed && (p_W - flight.p_started_W).norm() > 0.01) {
    predict(id, flight.started, effects);
    return;
  }
  flight.p_started_W = p_W;
  // Drop signals beyond the maximum range.
  if (config_.range_max_m && (p_W - transmission.p_W).norm() > *config_.range_max_m) {
    if (flight.addressed) ++to.counts_.lost[static_cast<std::size_t>(SignalLoss::range)];
    flight.loss = SignalLoss::range;
    end(id, to);
    effects.ended = true;
    return;
  }
  const SonarEquation::Level found = sonar_.level_at(to, p_W, flight.started, transmission);
  set_level(flight, found);
  if (found.later_s <= 0 || flight.delayed) {
    receive(id, found, to, effects);
    return;
  }
  // The direct path is blocked: the first arrival is an echo.
  flight.delayed = true;
  flight.travel_time_s += found.later_s;
  flight.started += from_seconds(found.later_s);
  flights_.update_hash(id, effects.sum);
  effects.schedule(flight.started, AcousticEvent::start);
}

/// Starts a reception whose level is known.
void Receptions::receive(FlightId id, const SonarEquation::Level& found, Transducer& to, ArrivalEffects& effects) {
  Flight& flight = flights_[id];
  const Transmission& transmission = transmissions_[flight.transmission];
  const Signal& signal = transmission.signal;
  flight.listened = to.listener_.listens_to(signal);
  flight.present = flight.loss == SignalLoss::none && medium_.in_water(flight.p_started_W);
  if (flight.present)
    to.receiver_.begin({id, signal.centre_Hz, signal.bandwidth_Hz, to_power(flight.level) + found.disturbing,
                        flight.ended, signal.kind == Signal::Kind::message},
                       flight.started);
  if (flight.listened) lock_on(id, found, to, effects);
  if (flight.detected) {
    if (const auto* const echo = sonar_.echo_lock(flight.snr, to, transmission, found.echoes)) {
      flight.lock_later_s = echo->later_s;
      flight.arrives_W = echo->arrives_W;
      flight.bent = true;
    }
  }
  flights_.update_hash(id, effects.sum);
  effects.schedule(flight.ended, AcousticEvent::end);
  if (!flight.present || !transmission.truncated()) return;
  if (const auto from = silent_from(id, transmission, flight.started)) effects.schedule(*from, AcousticEvent::silence);
}

/// Lets the receiver try to lock on to a signal.
void Receptions::lock_on(FlightId id, const SonarEquation::Level& found, Transducer& to, ArrivalEffects& effects) {
  Flight& flight = flights_[id];
  const Signal& signal = transmissions_[flight.transmission].signal;
  TakenSignal taken;
  taken.sound = {id, signal.centre_Hz, signal.bandwidth_Hz, to_power(flight.level), flight.ended};
  taken.noise = sonar_.noise_at(to, flight.p_started_W, signal);
  taken.disturbing = found.disturbing;
  taken.modulation = signal.modulation;
  taken.bit_rate_bps = signal.bit_rate_bps;
  taken.bits = signal.bits;
  taken.coding_gain_dB = signal.coding_gain_dB;
  taken.protection = to_power(Decibels{to.config().protection_dB});
  taken.started = flight.started;
  taken.ended = flight.ended;
  flight.snr = to_decibels(taken.sound.power / (taken.noise + found.disturbing));
  flight.loss = obstacle(flight, to);
  if (flight.loss != SignalLoss::none) return;
  FlightId displaced;
  flight.loss = to.receiver_.take(taken, {to.config().detection_dB, to.config().capture_dB}, displaced);
  flight.detected = flight.loss == SignalLoss::none;
  if (!displaced.valid()) return;
  flights_[displaced].loss = SignalLoss::captured;
  flights_.update_hash(displaced, effects.sum);
}

/// Returns the reason why a signal cannot be decoded, independent of other signals.
SignalLoss Receptions::obstacle(const Flight& flight, const Transducer& to) const {
  if (!medium_.in_water(flight.p_started_W)) return SignalLoss::out_of_water;
  if (!to.works()) return SignalLoss::receiver_off;
  if (flight.loss != SignalLoss::none) return flight.loss;  // blocked
  // SignalReceiver::take() tests this too; but an undetectable signal counts as lost in noise whatever the causes
  // below.
  if (flight.snr < Decibels{to.config().detection_dB}) return flight.shadow ? SignalLoss::shadow : SignalLoss::noise;
  if (flight.started < to.transmitting_until_) return SignalLoss::half_duplex;
  if (std::abs(flight.closing_mps) > to.config().doppler_limit_mps) return SignalLoss::doppler;
  return SignalLoss::none;
}

Decibels Receptions::end(FlightId id, Transducer& to) {
  Flight& flight = flights_[id];
  const Transmission& transmission = transmissions_[flight.transmission];
  // Determine the result of the reception.
  SignalReceiver::Outcome outcome;
  const bool taken = flight.present && to.receiver_.end(id, flight.ended, outcome);
  if (!flight.listened) return flight.snr;
  if (taken) {
    flight.loss = sonar_.lost(to, transmission, outcome, flight.loss);
    if (transmission.truncated()) flight.loss = transmission.truncated_by;
    if (!medium_.in_water(to.p_W(flight.ended))) flight.loss = SignalLoss::out_of_water;
    if (!to.works()) flight.loss = SignalLoss::receiver_off;
  }
  // Count messages addressed to the receiver.
  if (flight.addressed) ++to.counts_.lost[static_cast<std::size_t>(flight.loss)];
  if (flight.addressed && flight.loss == SignalLoss::none) {
    ++to.counts_.understood;
    to.counts_.understood_bytes += static_cast<std::int64_t>(transmission.signal.payload.size());
  }
  return taken ? to_decibels(outcome.worst_sinr) : flight.snr;
}

bool Receptions::notifies(const Flight& flight, const Transducer& to) const {
  return flight.listened && (flight.detected || to.listener_.wants_undetected());
}

void Receptions::notify(Transducer& to, const Flight& flight, Decibels sinr) const {
  const Transmission& transmission = transmissions_[flight.transmission];
  // The end of a signal is received when only the sender left the water.
  const bool out_itself =
      flight.loss == SignalLoss::out_of_water && transmission.truncated_by != SignalLoss::out_of_water;
  const bool deaf = out_itself || flight.loss == SignalLoss::receiver_off || flight.loss == SignalLoss::blocked ||
                    !to.works() || !medium_.in_water(to.p_W(flight.ended));
  if (deaf) return;
  const Vector3d back_W = transmission.p_W - flight.p_started_W;
  const Vector3d apparent_W = flight.bent ? Vector3d(-back_W.norm() * flight.arrives_W) : back_W;
  const Time started = flight.started + from_seconds(flight.lock_later_s);
  to.listener_.receive({transmission.signal, transmission.source, transmission.number, transmission.sent, started,
                        flight.ended, flight.travel_time_s + flight.lock_later_s, transmission.p_W, flight.p_started_W,
                        apparent_W, flight.level, flight.snr, sinr, flight.closing_mps, flight.loss, flight.detected});
}

void Receptions::silence(FlightId id, Time due) {
  Transducer* const to = flights_.receiver(id);
  if (to != nullptr && flights_[id].present) to->receiver_.silence(id, due);
}

std::optional<Time> Receptions::silent_from(FlightId id, const Transmission& transmission, Time now) const {
  const Flight& flight = flights_[id];
  const double whole_s = to_seconds(transmission.signal.duration);
  const double share = whole_s > 0 ? to_seconds(transmission.truncated_after) / whole_s : 1;
  const Time at = std::max(now, flight.started + from_seconds(share * to_seconds(flight.ended - flight.started)));
  return at < flight.ended ? std::optional(at) : std::nullopt;
}

void Receptions::abort_all(Transducer& of, SignalLoss why) {
  for (FlightId id = of.receiver_.drop(); id.valid(); id = of.receiver_.drop()) {
    flights_[id].loss = why;
    flights_.update_hash(id);
  }
}

void Receptions::update_noise() {
  flights_.for_each([&](FlightId id, const Flight& flight) {
    Transducer* const to = flight.detected ? flights_.receiver(flight) : nullptr;
    if (to == nullptr || !to->receiver_.takes(id)) return;
    const Signal& signal = transmissions_[flight.transmission].signal;
    const PowerRatio noise = sonar_.noise_at(*to, to->p_W(medium_.now()), signal);
    to->receiver_.set_noise(id, noise, medium_.now());
  });
}

}  // namespace sim
