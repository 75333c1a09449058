// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/channel.hpp"

#include <algorithm>
#include <utility>

#include "sim/acoustics/propagation/sound_path.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/device/fault.hpp"

namespace sim {

namespace {

/// Fraction of the travel time before the estimated arrival at which the arrival is computed exactly; it bounds the
/// closing speed as a fraction of the speed of sound.
constexpr double early = 0.02;
/// The same for rays, which may be faster than the straight line through slow water.
constexpr double early_ray = 0.06;
/// Interval of the checks of active senders and receivers.
constexpr Time watch_period{100'000};

}  // namespace

AcousticChannel::AcousticChannel(const AcousticsConfig& config, const AcousticSurroundings& surroundings)
    : config_(config),
      around_(surroundings),
      flights_(transducers_),
      sonar_(config_, surroundings.medium, surroundings.physics, surroundings.seed),
      receptions_(config_, surroundings.medium, sonar_, clock_, transmissions_, flights_),
      search_(config_, surroundings.medium, sonar_.propagation(), transducers_),
      reports_(surroundings.medium, transducers_) {}

AcousticChannel::~AcousticChannel() = default;

std::vector<std::string> AcousticChannel::effects() const {
  std::vector<std::string> effects;
  if (propagation().bends()) effects.emplace_back("propagation");
  if (propagation().bends() && config_.shadow_loss_dB) effects.emplace_back("shadow_loss_dB");
  if (config_.echo_lock && config_.multipath) effects.emplace_back("echo_lock");
  return effects;
}

void AcousticChannel::add(Transducer& transducer) {
  transducers_.add(transducer);
  transducer.addressed_before_ = messages_.sent_to(transducer.own_);
  clear_receivers();
}

void AcousticChannel::remove(Transducer& transducer) {
  if (transducer.transmission_.valid())
    truncate(transducer.transmission_, SignalLoss::sender_off, around_.medium.now());
  transducers_.remove(transducer);
  transmissions_.cancel_pending(transducer, {});
  flights_.discard_sum();
  if (!transducers_.any_has(transducer.own_)) messages_.discard(transducer.own_);
  clear_receivers();
}

void AcousticChannel::add(ContinuousSound& sound) {
  sonar_.add(sound);
  noise_changed();
}

void AcousticChannel::remove(ContinuousSound& sound) {
  sonar_.remove(sound);
  noise_changed();
}

void AcousticChannel::transmit(Transducer& from, Signal signal, Time at) {
  const Time ended = at + signal.duration;
  const TransmissionId id = transmissions_.add(from, ++from.signals_, std::move(signal), at);
  schedule_event(at, AcousticEvent::transmission_start, id.number);
  schedule_event(ended, AcousticEvent::transmission_end, id.number);
}

Time AcousticChannel::cancel_pending(Transducer& from) {
  transmissions_.cancel_pending(from, from.transmission_);
  return from.transmission_.valid() ? from.transmitting_until_ : around_.medium.now();
}

/// Loads the flight of a later event into the cache: with many signals in transit, consecutive ones are far apart in
/// memory.
void AcousticChannel::prefetch() const {
  constexpr std::size_t events_ahead = 6;
  const std::optional<Time> item = around_.events.stamp_ahead(events_ahead, Event::of_acoustics);
  if (!item || !flights_.contains(item->count())) return;
  const Flight* const flight = &flights_[FlightId{static_cast<int>(item->count())}];
  __builtin_prefetch(flight, 1);
  __builtin_prefetch(reinterpret_cast<const char*>(flight + 1) - 1, 1);
}

void AcousticChannel::handle(const Event& event, Time now) {
  clock_.begin(now);
  prefetch();
  const int number = static_cast<int>(event.stamp.count());
  const TransmissionId transmission{number};
  const FlightId flight{number};
  const auto kind = static_cast<AcousticEvent>(event.kind);
  // Dispatch by the kind of event; a snapshot may have others.
  switch (kind) {
    case AcousticEvent::transmission_start:
      start_transmission(transmission, now);
      break;
    case AcousticEvent::transmission_end:
      end_transmission(transmission, event.due);
      break;
    case AcousticEvent::near:
    case AcousticEvent::start: {
      ArrivalEffects effects;
      receptions_.handle(flight, kind, event.due, effects);
      apply(flight, effects);
      break;
    }
    case AcousticEvent::end:
      end_flight(flight);
      break;
    case AcousticEvent::watch:
      watch();
      break;
    case AcousticEvent::silence:
      receptions_.silence(flight, event.due);
      break;
    default:
      break;
  }
  clock_.end();
}

void AcousticChannel::start_transmission(TransmissionId id, Time now) {
  Transmission& transmission = transmissions_[id];
  const Signal& signal = transmission.signal;
  // Without power or out of the water the signal is not sent.
  Transducer* const from = transmission.from;
  if (from == nullptr || !from->works() || !around_.medium.in_water(from->p_W(transmission.sent))) {
    if (from != nullptr) ++from->counts_.unsent;
    transmissions_.release(id);
    return;
  }
  // Record pose, velocity and pattern of the sender at transmission.
  transmission.p_W = from->p_W(transmission.sent);
  transmission.v_W = from->v_W();
  transmission.R_WS = from->R_WS();
  transmission.directivity = from->config().directivity;
  from->transmission_ = id;
  if (!std::exchange(watching_, true)) schedule_event(now + watch_period, AcousticEvent::watch, 0);
  // Count messages, and abort receptions of the sender (half duplex).
  from->transmitting_until_ = std::max(from->transmitting_until_, transmission.sent + signal.duration);
  if (signal.kind == Signal::Kind::message) {
    ++from->counts_.sent;
    from->counts_.sent_bytes += static_cast<std::int64_t>(signal.payload.size());
    messages_.count(signal.to);
    if (from->is_addressee_of(signal)) ++from->addressed_in_range_;
  }
  receptions_.abort_all(*from, SignalLoss::half_duplex);

  const double range_m = search_.update_range(signal, now);
  for (Transducer* const to : search_.receivers(transmission, range_m)) add_flight(id, *to);
  reports_.transmitted(transmission, range_m);
  transmissions_.release(id);
}

void AcousticChannel::add_flight(TransmissionId id, Transducer& to) {
  Transmission& transmission = transmissions_[id];
  const Signal& signal = transmission.signal;
  const FlightId added = flights_.add();
  Flight& flight = flights_[added];
  flight.transmission = id;
  flight.set_receiver(&to);
  flight.addressed =
      signal.kind == Signal::Kind::message && to.is_addressee_of(signal) && to.listener_.listens_to(signal);
  if (flight.addressed) ++to.addressed_in_range_;
  ++transmission.users;
  transmission.flights.push_back(added);
  const double travel_s = travel_time_s(around_.medium, transmission.p_W, to.p_W(transmission.sent));
  const double share = propagation().bends() ? early_ray : early;
  flights_.update_hash(added);
  schedule_event(transmission.sent + from_seconds(travel_s * (1 - share)), AcousticEvent::near, added.number);
}

void AcousticChannel::end_transmission(TransmissionId id, Time at) {
  Transducer* const from = transmissions_[id].from;
  if (from != nullptr && from->transmission_ == id) {
    // Lost power or left the water since the last check: the end of the signal is missing.
    if (!from->works())
      truncate(id, SignalLoss::sender_off, at);
    else if (!around_.medium.in_water(from->p_W(at)))
      truncate(id, SignalLoss::out_of_water, at);
    from->transmission_ = {};
  }
  transmissions_.release(id);
}

void AcousticChannel::truncate(TransmissionId id, SignalLoss why, Time at) {
  transmissions_.truncate(id, why, at);
  const Transmission& transmission = transmissions_[id];
  if (Transducer* const from = transmission.from) {
    from->transmission_ = {};
    from->transmitting_until_ = std::min(from->transmitting_until_, at);
  }
  for (const FlightId each : transmission.flights) {
    const Flight& flight = flights_[each];
    if (flight.transmission != id || !flight.present) continue;
    if (const auto from = receptions_.silent_from(each, transmission, at))
      schedule_event(*from, AcousticEvent::silence, each.number);
  }
}

void AcousticChannel::watch() {
  bool more = false;
  transducers_.for_each([&](Transducer& each) {
    if (!each.transmission_.valid() && !each.receiving()) return;
    more = true;
    const bool works = each.works();
    if (works && around_.medium.in_water(each.p_W(clock_.step_end()))) return;
    if (each.transmission_.valid())
      truncate(each.transmission_, works ? SignalLoss::out_of_water : SignalLoss::sender_off, clock_.step_end());
    receptions_.abort_all(each, works ? SignalLoss::out_of_water : SignalLoss::receiver_off);
  });
  watching_ = more;
  if (more) schedule_event(clock_.step_end() + watch_period, AcousticEvent::watch, 0);
}

void AcousticChannel::end_flight(FlightId id) {
  if (Transducer* const to = flights_.receiver(id)) {
    const Decibels sinr = receptions_.end(id, *to);
    report_arrival(id);
    if (receptions_.notifies(flights_[id], *to)) receptions_.notify(*to, flights_[id], sinr);
  }
  remove_flight(id);
}

void AcousticChannel::apply(FlightId id, const ArrivalEffects& effects) {
  flights_.add_to_sum(effects.sum);
  for (int i = 0; i < effects.count; ++i) {
    const ArrivalEffects::Due& event = effects.events[static_cast<std::size_t>(i)];
    schedule_event(event.at, event.kind, id.number);
  }
  if (!effects.ended) return;
  report_arrival(id);
  remove_flight(id);
}

void AcousticChannel::report_arrival(FlightId id) {
  const Flight& flight = flights_[id];
  if (const Transducer* const to = flights_.receiver(flight))
    reports_.arrived(flight, transmissions_[flight.transmission], *to);
}

void AcousticChannel::remove_flight(FlightId id) {
  const TransmissionId of = flights_[id].transmission;
  flights_.remove(id);
  transmissions_.release(of);
}

bool AcousticChannel::defer(const Event& event, Time now) {
  const auto kind = static_cast<AcousticEvent>(event.kind);
  if (!is_of_flight(kind)) return false;
  prefetch();
  const FlightId id{static_cast<int>(event.stamp.count())};
  const Flight& flight = flights_[id];
  if (kind != AcousticEvent::end) {
    // The end of a short signal may be due in this step, and change more than its receiver.
    if (transmissions_[flight.transmission].signal.duration <= 2 * (now - event.due)) return false;
  } else if (const Transducer* const to = flights_.receiver(flight)) {
    if (receptions_.notifies(flight, *to)) return false;
  }
  deferred_.add(id, kind, event.due, flight.to.number);
  return true;
}

bool AcousticChannel::handle_deferred(Time until, Time now, ThreadPool* threads) {
  if (deferred_.empty()) return false;
  clock_.begin(now);
  const Scene& scene = around_.physics.scene();
  if (config_.occlusion || config_.multipath || propagation().bends()) scene.prepare();
  deferred_.handle(
      until, scene.concurrent() ? threads : nullptr,
      [&](FlightId id, AcousticEvent kind, Time due, ArrivalEffects& effects) {
        receptions_.handle(id, kind, due, effects);
      },
      [&](FlightId id, const ArrivalEffects& effects) { apply(id, effects); });
  clock_.end();
  return true;
}

void AcousticChannel::visit_state(StateArchive& archive) {
  transducers_.visit_each(archive);
  sonar_.visit_state(archive);
  auto transmissions = static_cast<std::uint64_t>(transmissions_.size());
  auto flights = static_cast<std::uint64_t>(flights_.size());
  archive(transmissions, flights);
  transmissions_.visit_items(archive, transmissions, transducers_);
  flights_.visit_items(archive, flights, transmissions_);
  transmissions_.visit_free(archive);
  flights_.visit_free(archive);
  flights_.visit_made(archive);
  clock_.visit_state(archive);
  search_.visit_state(archive);
  archive.unhashed(messages_, watching_);
  transducers_.visit_removed(archive);
  reports_.visit_state(archive);
  if (!archive.restoring()) return;
  deferred_.clear();  // of a step that failed
  // Bands are added to a cache, which threads must not do.
  transmissions_.for_each([&](TransmissionId, const Transmission& each) {
    propagation().ambient_level(each.signal.centre_Hz, each.signal.bandwidth_Hz);
  });
  check_numbers(archive);
}

std::uint64_t AcousticChannel::content_hash() {
  StateArchive hash = StateArchive::quick_hasher();
  transducers_.for_each([&](Transducer& each) { each.add_content(hash); });
  sonar_.visit_state(hash);
  transmissions_.visit_items(hash, transmissions_.size(), transducers_);
  flights_.add_content(hash);
  return hash.hash();
}

/// Checks all restored numbers that are used as indices.
void AcousticChannel::check_numbers(const StateArchive& archive) const {
  const auto fail = [&] { archive.fail("a signal that does not exist"); };
  const std::vector<char> transmission_used = transmissions_.used(archive), flight_used = flights_.used(archive);
  flights_.for_each([&](FlightId id, const Flight& flight) {
    const TransmissionId of = flight.transmission;
    if (at(flight_used, id) && !(transmissions_.contains(of.number) && at(transmission_used, of))) fail();
  });
  transducers_.for_each([&](const Transducer& each) {
    const TransmissionId present = each.transmission_;
    const bool in_range = present == TransmissionId{} || transmissions_.contains(present.number);
    if (!in_range || !each.receiver_.flights_are_below(flights_.size())) fail();
  });
  search_.check(archive);
}

/// Checks that each transmission in use has exactly the events and flights that it counts, and each flight one event;
/// otherwise a transmission could be removed while it is still needed.
void AcousticChannel::check_events(std::span<const Event> events, const StateArchive& archive) const {
  std::vector<int> users(transmissions_.size(), 0), flight_events(flights_.size(), 0);
  const std::vector<char> transmission_used = transmissions_.used(archive), flight_used = flights_.used(archive);
  flights_.for_each([&](FlightId id, const Flight& flight) {
    if (at(flight_used, id)) ++at(users, flight.transmission);
  });
  for (const Event& event : events) {
    if (event.device != Event::of_acoustics) continue;
    const auto kind = static_cast<AcousticEvent>(event.kind);
    if (!is_of_transmission(kind) && !is_of_flight(kind) && kind != AcousticEvent::silence) continue;
    const std::int64_t number = event.stamp.count();
    const bool exists = is_of_transmission(kind) ? transmissions_.contains(number) : flights_.contains(number);
    if (!exists) archive.fail("a signal that does not exist");
    if (is_of_transmission(kind)) ++at(users, TransmissionId{static_cast<int>(number)});
    if (is_of_flight(kind)) ++at(flight_events, FlightId{static_cast<int>(number)});
  }
  transmissions_.for_each([&](TransmissionId id, const Transmission& each) {
    if (at(users, id) != (at(transmission_used, id) ? each.users : 0))
      archive.fail("a signal whose users do not exist");
  });
  flights_.for_each([&](FlightId id, const Flight&) {
    if (at(flight_events, id) != at(flight_used, id))
      archive.fail("a signal in flight that never arrives, or arrives twice");
  });
}

}  // namespace sim
