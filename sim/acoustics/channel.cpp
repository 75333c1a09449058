// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/channel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "sim/acoustics/sound_path.hpp"
#include "sim/device/fault.hpp"

namespace sim {

namespace {

/// Fraction of the travel time before the estimated arrival at which the arrival is computed exactly; it bounds the
/// closing speed as a fraction of the speed of sound.
constexpr double early = 0.02;
/// The same for rays, which may be faster than the straight line through slow water.
constexpr double early_ray = 0.06;
/// Validity of the list of neighbors, and the distance that no transducer moves farther in this time or while a sound
/// travels.
constexpr double neighbors_hold_s = 1;
constexpr double stray_m = 150;
/// Interval of the checks of active senders and receivers.
constexpr Time watch_period{100'000};

}  // namespace

const char* signal_loss_word(SignalLoss loss) {
  static constexpr const char* words[signal_losses] = {
      "none",    "noise",        "interference", "half_duplex", "busy",  "captured",   "doppler",
      "blocked", "out_of_water", "receiver_off", "link",        "range", "sender_off", "shadow"};
  return words[static_cast<std::size_t>(loss)];
}

AcousticChannel::AcousticChannel(const AcousticsConfig& config, const AcousticSurroundings& surroundings)
    : config_(config), around_(surroundings), propagation_(config_, surroundings.medium, surroundings.physics) {}

AcousticChannel::~AcousticChannel() = default;

std::vector<std::string> AcousticChannel::effects() const {
  std::vector<std::string> effects;
  if (propagation_.bends()) effects.emplace_back("propagation");
  if (propagation_.bends() && config_.shadow_loss_dB) effects.emplace_back("shadow_loss_dB");
  if (config_.echo_lock && config_.multipath) effects.emplace_back("echo_lock");
  return effects;
}

void AcousticChannel::join(Transducer& transducer) {
  const auto free = std::find(transducers_.begin(), transducers_.end(), nullptr);
  auto number = static_cast<std::size_t>(free - transducers_.begin());
  if (!prescribed_.empty()) {
    number = static_cast<std::size_t>(prescribed_.back());
    prescribed_.pop_back();
  }
  if (number >= transducers_.size()) transducers_.resize(number + 1);
  transducers_[number] = &transducer;
  transducer.number_ = static_cast<int>(number);
  transducer.join_ = ++joins_;
  transducer.meant_before_ = messages_for(transducer.own_);
  clear_receivers();
}

bool AcousticChannel::prescribe(std::vector<int> numbers) {
  constexpr int upper = 10'000'000;
  for (const int number : numbers) {
    const auto at = static_cast<std::size_t>(number);
    if (number < 0 || number >= upper || (at < transducers_.size() && transducers_[at] != nullptr)) return false;
  }
  if (std::set<int>(numbers.begin(), numbers.end()).size() != numbers.size()) return false;
  std::reverse(numbers.begin(), numbers.end());
  prescribed_ = std::move(numbers);
  return true;
}

void AcousticChannel::leave(Transducer& transducer) {
  const Transducer::Counts counts = transducer.counts();
  removed_.sent += counts.sent;
  removed_.sent_bytes += counts.sent_bytes;
  removed_.understood += counts.understood;
  removed_.understood_bytes += counts.understood_bytes;
  removed_.unsent += counts.unsent;
  for (std::size_t i = 0; i < counts.lost.size(); ++i) removed_.lost[i] += counts.lost[i];
  if (transducer.sending_ >= 0) cut(transducer.sending_, SignalLoss::sender_off, around_.medium.now());
  transducers_[static_cast<std::size_t>(transducer.number())] = nullptr;
  for (const auto& sending : sendings_)
    if (sending && sending->from == &transducer) sending->from = nullptr;
  sum_outdated_ = true;  // by flights to it
  discard_messages_for(transducer.own_);
  clear_receivers();
}

/// Bounds the memory for the counts of addresses that are added and removed.
void AcousticChannel::discard_messages_for(const Audience& removed) {
  const auto group = messages_.find(removed.group);
  if (removed.address.empty() || group == messages_.end() || !group->second.contains(removed.address)) return;
  const bool is_used = std::any_of(transducers_.begin(), transducers_.end(), [&](const Transducer* each) {
    return each != nullptr && each->own_.address == removed.address && each->own_.group == removed.group;
  });
  if (!is_used) group->second.erase(removed.address);
}

void AcousticChannel::discard_places() {
  neighbors_age_ = -1;
}

void AcousticChannel::clear_receivers() {
  min_levels_.clear();
  discard_places();
}

std::int64_t AcousticChannel::messages_for(const Audience& own) const {
  const auto group = messages_.find(own.group);
  if (group == messages_.end()) return 0;
  const auto to = [&](const std::string& address) {
    const auto count = group->second.find(address);
    return count == group->second.end() ? 0 : count->second;
  };
  return to("") + (own.address.empty() ? 0 : to(own.address));
}

void AcousticChannel::join(ContinuousSound& sound) {
  sounds_.push_back(&sound);
  noise_changed();
}

void AcousticChannel::leave(ContinuousSound& sound) {
  std::erase(sounds_, &sound);
  noise_changed();
}

void AcousticChannel::noise_changed() {
  for (std::size_t i = 0; i < flights_.size(); ++i) {
    const Flight& flight = flights_[i];
    const auto number = static_cast<std::int64_t>(i);
    Transducer* const to = flight.detected ? receiver_of(flight) : nullptr;
    if (to == nullptr || !to->receiver_.takes(number)) continue;
    const Signal& signal = sendings_[static_cast<std::size_t>(flight.sending)]->signal;
    const PowerRatio noise = noise_at(*to, to->p_W(around_.medium.now()), signal);
    to->receiver_.set_noise(number, noise, around_.medium.now());
  }
}

Decibels AcousticChannel::min_level(double frequency_Hz) const {
  for (const auto& [known_Hz, below] : min_levels_)
    if (known_Hz == frequency_Hz) return below;
  const Decibels below = compute_min_level(frequency_Hz);
  constexpr std::size_t max_frequencies = 64;
  if (min_levels_.size() < max_frequencies) min_levels_.emplace_back(frequency_Hz, below);
  return below;
}

Decibels AcousticChannel::compute_min_level(double frequency_Hz) const {
  examined_ += static_cast<std::int64_t>(transducers_.size());
  double below_dB = config_.negligible_dB;
  for (const Transducer* each : transducers_)
    if (each != nullptr)
      below_dB = std::max(below_dB, each->noise_reduction(frequency_Hz).dB() - each->config().detection_dB);
  double gain_dB = 0;
  for (const LinkConfig& link : config_.links) gain_dB += std::max(0.0, -link.extra_loss_dB);
  // Margin for fading: exceeded by at most one signal in fifty.
  if (config_.fading.type == FadingConfig::Type::rayleigh) gain_dB += 6;
  if (config_.fading.type == FadingConfig::Type::log_normal) gain_dB += 2 * config_.fading.std_dB;
  return Decibels{below_dB + gain_dB};
}

bool AcousticChannel::can(const Transducer& transducer) const {
  return transducer.works() && around_.medium.in_water(transducer.p_W(step_end_));
}

void AcousticChannel::watch() {
  bool more = false;
  for (Transducer* each : transducers_) {
    if (each == nullptr || (each->sending_ < 0 && !each->receiver_.taking())) continue;
    more = true;
    if (can(*each)) continue;
    const bool works = each->works();
    if (each->sending_ >= 0) cut(each->sending_, works ? SignalLoss::out_of_water : SignalLoss::sender_off, step_end_);
    const SignalLoss loss = works ? SignalLoss::out_of_water : SignalLoss::receiver_off;
    drop_receptions(*each, loss);
  }
  watching_ = more;
  if (more) schedule(step_end_ + watch_period, watch_event, 0);
}

void AcousticChannel::drop_receptions(Transducer& of, SignalLoss why) {
  for (std::int64_t flight = of.receiver_.drop(); flight >= 0; flight = of.receiver_.drop()) {
    flights_[static_cast<std::size_t>(flight)].loss = why;
    update_hash(static_cast<int>(flight), flights_sum_);
  }
}

int AcousticChannel::new_sending() {
  if (free_sendings_.empty()) {
    free_sendings_.push_back(static_cast<int>(sendings_.size()));
    sendings_.push_back(std::make_unique<Sending>());
  }
  const int number = free_sendings_.back();
  free_sendings_.pop_back();
  return number;
}

int AcousticChannel::new_flight() {
  ++flights_made_;
  if (free_flights_.empty()) {
    free_flights_.push_back(static_cast<int>(flights_.size()));
    flights_.emplace_back();
  }
  const int number = free_flights_.back();
  free_flights_.pop_back();
  return number;
}

void AcousticChannel::release(int number) {
  Sending& sending = *sendings_[static_cast<std::size_t>(number)];
  if (--sending.users > 0) return;
  sending = {};
  free_sendings_.push_back(number);
}

void AcousticChannel::schedule(Time due, EventKind kind, int item) {
  Event event;
  event.due = due;
  event.device = Event::of_acoustics;
  event.kind = kind;
  event.stamp = Time{item};
  around_.events.schedule(std::move(event));
}

void AcousticChannel::transmit(Transducer& from, Signal signal, Time at) {
  const int number = new_sending();
  Sending& sending = *sendings_[static_cast<std::size_t>(number)];
  sending.signal = std::move(signal);
  sending.from = &from;
  sending.source = from.full_name();
  sending.number = from.number();
  sending.group = from.group();
  sending.sequence = ++from.signals_;
  sending.sent = at;
  sending.users = 2;  // the two events below
  schedule(at, emission_event, number);
  schedule(at + sending.signal.duration, emission_end_event, number);
}

Time AcousticChannel::call_back(Transducer& from) {
  for (std::size_t i = 0; i < sendings_.size(); ++i)
    if (sendings_[i]->from == &from && from.sending_ != static_cast<int>(i)) sendings_[i]->from = nullptr;
  return from.sending_ >= 0 ? from.sending_until_ : around_.medium.now();
}

void AcousticChannel::set_receiver(Flight& flight, const Transducer* to) {
  flight.to = to != nullptr ? to->number() : -1;
  flight.to_join = to != nullptr ? to->join_ : 0;
}

void AcousticChannel::begin_handling(Time now) {
  if (now != step_end_) ++polls_;
  step_end_ = now;
  handling_ = true;
}

/// Loads the flight of a later event into the cache: with many signals in transit, consecutive ones are far apart in
/// memory.
void AcousticChannel::fetch_ahead() const {
  constexpr std::size_t events_ahead = 6;
  const std::optional<Time> item = around_.events.stamp_ahead(events_ahead, Event::of_acoustics);
  if (!item || item->count() < 0 || static_cast<std::uint64_t>(item->count()) >= flights_.size()) return;
  const Flight* const flight = &flights_[static_cast<std::size_t>(item->count())];
  __builtin_prefetch(flight, 1);
  __builtin_prefetch(reinterpret_cast<const char*>(flight + 1) - 1, 1);
}

void AcousticChannel::handle(const Event& event, Time now) {
  begin_handling(now);
  fetch_ahead();
  const int item = static_cast<int>(event.stamp.count());
  // Dispatch by the kind of event.
  switch (event.kind) {
    case emission_event:
      emit(item, now);
      break;
    case emission_end_event:
      end_emission(item, event.due);
      break;
    case near_event:
    case start_event: {
      Consequences consequences;
      handle_at_receiver(item, static_cast<EventKind>(event.kind), event.due, consequences);
      carry_out(item, consequences);
      break;
    }
    case end_event:
      end(item);
      break;
    case watch_event:
      watch();
      break;
    case silence_event:
      fall_silent(item, event.due);
      break;
    default:
      break;
  }
  handling_ = false;
}

void AcousticChannel::emit(int number, Time now) {
  Sending& sending = *sendings_[static_cast<std::size_t>(number)];
  // Without power or out of the water the signal is not sent.
  Transducer* from = sending.from;
  if (from == nullptr || !from->works() || !around_.medium.in_water(from->p_W(sending.sent))) {
    if (from != nullptr) ++from->counts_.unsent;
    release(number);
    return;
  }
  // Record pose, velocity and pattern of the sender at transmission.
  sending.p_W = from->p_W(sending.sent);
  sending.v_W = from->v_W();
  sending.R_WS = from->R_WS();
  sending.directivity = from->config().directivity;
  from->sending_ = number;
  if (!watching_) {
    watching_ = true;
    schedule(now + watch_period, watch_event, 0);
  }
  // Count messages, and abort receptions of the sender (half duplex).
  from->sending_until_ = std::max(from->sending_until_, sending.sent + sending.signal.duration);
  if (sending.signal.kind == Signal::Kind::message) {
    ++from->counts_.sent;
    from->counts_.sent_bytes += static_cast<std::int64_t>(sending.signal.payload.size());
    ++messages_[sending.signal.to.group][sending.signal.to.address];
    if (from->is_meant_by(sending.signal)) ++from->meant_near_;
  }
  drop_receptions(*from, SignalLoss::half_duplex);

  // Send to each transducer in audible range.
  const double reach_m = update_neighbors(sending.signal, now) + stray_m;
  neighbors_.near(sending.p_W, reach_m, near_);
  examined_ += static_cast<std::int64_t>(near_.size());
  for (const int listener : near_) {
    Transducer* to = transducers_[static_cast<std::size_t>(listener)];
    if (to != nullptr && to != from && (to->p_W(sending.sent) - sending.p_W).norm() <= reach_m) send_to(number, *to);
  }
  if (observer_ != nullptr) {
    report_sent(sending);
    report_beyond_range(sending, reach_m);
  }
  release(number);
}

double AcousticChannel::update_neighbors(const Signal& signal, Time now) {
  const bool anew = neighbors_age_ < 0 || to_seconds(now) - neighbors_age_ > neighbors_hold_s;
  std::vector<Neighborhood::Member> members;
  // Collect the positions of all transducers.
  if (anew) {
    lowest_m_ = std::numeric_limits<double>::infinity();
    for (const Transducer* each : transducers_) {
      if (each == nullptr) continue;
      members.push_back({each->number(), each->p_W(now)});
      lowest_m_ = std::min(lowest_m_, members.back().p_W.z());
    }
    examined_ += static_cast<std::int64_t>(transducers_.size());
    neighbors_age_ = to_seconds(now);
  }
  const double deepest_m = around_.medium.highest_surface_m() - lowest_m_ + stray_m;
  const double reach_m = propagation_.audible_range_m(signal, min_level(signal.centre_Hz), deepest_m);
  if (anew) neighbors_.build(members, reach_m);
  return reach_m;
}

void AcousticChannel::send_to(int number, Transducer& to) {
  Sending& sending = *sendings_[static_cast<std::size_t>(number)];
  const Signal& signal = sending.signal;
  const int flight_number = new_flight();
  Flight& flight = flights_[static_cast<std::size_t>(flight_number)];
  flight.sending = number;
  set_receiver(flight, &to);
  flight.meant = signal.kind == Signal::Kind::message && to.is_meant_by(signal) && to.listener_.listens_to(signal);
  if (flight.meant) ++to.meant_near_;
  ++sending.users;
  sending.flights.push_back(flight_number);
  const double travel_s = travel_time_s(around_.medium, sending.p_W, to.p_W(sending.sent));
  const double share = propagation_.bends() ? early_ray : early;
  update_hash(flight_number, flights_sum_);
  schedule(sending.sent + from_seconds(travel_s * (1 - share)), near_event, flight_number);
}

void AcousticChannel::end_emission(int number, Time at) {
  Sending& sending = *sendings_[static_cast<std::size_t>(number)];
  Transducer* const from = sending.from;
  if (from != nullptr && from->sending_ == number) {
    // Lost power or left the water since the last check: the end of the signal is missing.
    if (!from->works())
      cut(number, SignalLoss::sender_off, at);
    else if (!around_.medium.in_water(from->p_W(at)))
      cut(number, SignalLoss::out_of_water, at);
    from->sending_ = -1;
  }
  release(number);
}

void AcousticChannel::cut(int number, SignalLoss why, Time at) {
  Sending& sending = *sendings_[static_cast<std::size_t>(number)];
  sending.cut = why;
  sending.cut_after = std::clamp(at - sending.sent, Time{0}, sending.signal.duration);
  if (sending.from != nullptr) {
    sending.from->sending_ = -1;
    sending.from->sending_until_ = std::min(sending.from->sending_until_, at);
  }
  for (const int i : sending.flights) {
    const Flight& flight = flights_[static_cast<std::size_t>(i)];
    if (flight.sending != number || !flight.present) continue;
    if (const auto from = silent_from(i, sending, at)) schedule(*from, silence_event, i);
  }
}

std::optional<Time> AcousticChannel::silent_from(int number, const Sending& sending, Time now) const {
  const Flight& flight = flights_[static_cast<std::size_t>(number)];
  const double whole_s = to_seconds(sending.signal.duration);
  const double share = whole_s > 0 ? to_seconds(sending.cut_after) / whole_s : 1;
  const Time at = std::max(now, flight.started + from_seconds(share * to_seconds(flight.ended - flight.started)));
  return at < flight.ended ? std::optional(at) : std::nullopt;
}

/// Corrects the arrival along the straight line to that of the first ray: Newton's method on the travel time, whose
/// derivative by the position of the receiver is the direction of the sound over its speed.
void AcousticChannel::follow_ray(Arrival& arrival, const Sending& sending, const Vector3d& velocity_W) const {
  for (int round = 0; round < 4; ++round) {
    const Propagation::First first = propagation_.first_arrival(sending.p_W, arrival.p_W, sending.signal.centre_Hz);
    const double c_mps = around_.medium.sound_speed_mps(arrival.p_W);
    const double change_s =
        (first.travel_time_s - arrival.travel_time_s) / (1 - first.arrives_W.dot(velocity_W) / c_mps);
    arrival.travel_time_s += change_s;
    arrival.p_W += velocity_W * change_s;
    // The remaining error is of second order: nanoseconds at most.
    if (std::abs(change_s) < 2e-3) return;
  }
}

std::optional<Arrival> AcousticChannel::arrival_at(const Transducer& to, const Sending& sending) const {
  auto arrival = meeting(around_.medium, sending.p_W, sending.sent, to.p_W(step_end_), step_end_, to.v_W());
  if (arrival && propagation_.bends()) follow_ray(*arrival, sending, to.v_W());
  return arrival;
}

void AcousticChannel::approach(int number, Time due, Consequences& out) {
  Flight& flight = flights_[static_cast<std::size_t>(number)];
  if (const Transducer* const to = receiver_of(flight)) {
    const Sending& sending = *sendings_[static_cast<std::size_t>(flight.sending)];
    const std::optional<Arrival> arrival = arrival_at(*to, sending);
    if (arrival) {
      flight.travel_time_s = arrival->travel_time_s;
      flight.started = std::max(due, sending.sent + from_seconds(arrival->travel_time_s));
      flight.p_started_W = to->p_W(flight.started);
    } else {
      set_receiver(flight, nullptr);  // faster than sound: the body has diverged
    }
  }
  update_hash(number, out.sum);
  out.schedule(std::max(flight.started, due), start_event);
}

}  // namespace sim
