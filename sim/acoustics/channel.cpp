#include "sim/acoustics/channel.hpp"

#include <algorithm>
#include <cmath>

#include "sim/acoustics/sound_path.hpp"
#include "sim/device/fault.hpp"
#include "sim/world/vehicle.hpp"

namespace sim {

namespace {

/// Nobody closes in on a sound faster than by this share of its speed; the last part of the way is worked out when
/// the sound is so near.
constexpr double early = 0.02;
/// Who is near whom holds so long; and nobody goes farther meanwhile, nor while a sound is under way.
constexpr double neighbours_hold_s = 1;
constexpr double stray_m = 150;
/// How often those who send or take signals are looked after.
constexpr Time watch_period{100'000};
/// A gain below this is none.
constexpr double lowest_dB = -1000;

}  // namespace

const char* signal_loss_word(SignalLoss loss) {
  static constexpr const char* words[signal_losses] = {"none",         "noise",        "interference", "half_duplex",
                                                       "busy",         "captured",     "doppler",      "blocked",
                                                       "out_of_water", "receiver_off", "link"};
  return words[static_cast<std::size_t>(loss)];
}

AcousticChannel::AcousticChannel(const AcousticsConfig& config, const AcousticSurroundings& surroundings)
    : config_(config), around_(surroundings), propagation_(config_, surroundings.medium, surroundings.physics) {}

AcousticChannel::~AcousticChannel() = default;

int AcousticChannel::join(Transducer& transducer) {
  const auto free = std::find(transducers_.begin(), transducers_.end(), nullptr);
  forget_places();
  if (free == transducers_.end()) {
    transducers_.push_back(&transducer);
    return static_cast<int>(transducers_.size()) - 1;
  }
  *free = &transducer;
  return static_cast<int>(free - transducers_.begin());
}

void AcousticChannel::leave(Transducer& transducer) {
  const Transducer::Counts& counts = transducer.counts_;
  gone_.sent += counts.sent;
  gone_.sent_bytes += counts.sent_bytes;
  gone_.understood += counts.understood;
  gone_.understood_bytes += counts.understood_bytes;
  gone_.unsent += counts.unsent;
  for (std::size_t i = 0; i < counts.lost.size(); ++i) gone_.lost[i] += counts.lost[i];
  transducers_[static_cast<std::size_t>(transducer.number())] = nullptr;
  for (const auto& sending : sendings_)
    if (sending && sending->from == &transducer) sending->from = nullptr;
  for (Flight& flight : flights_)
    if (flight.to == &transducer) flight.to = nullptr;
  forget_places();
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
    if (flight.to == nullptr || !flight.noticed || !flight.to->receiver_.takes(number)) continue;
    const Signal& signal = sendings_[static_cast<std::size_t>(flight.sending)]->signal;
    const PowerRatio noise = noise_at(*flight.to, flight.to->p_W(around_.medium.now()), signal);
    flight.to->receiver_.set_noise(number, noise, around_.medium.now());
  }
}

Decibels AcousticChannel::faintest(double frequency_Hz) const {
  double below_dB = config_.inaudible_dB;
  for (const Transducer* each : transducers_)
    if (each != nullptr)
      below_dB = std::max(below_dB, each->noise_reduction(frequency_Hz).dB() - each->config().detection_dB);
  double gain_dB = 0;
  for (const LinkConfig& link : config_.links) gain_dB += std::max(0.0, -link.extra_loss_dB);
  // Fading makes one signal in fifty or fewer stronger than this.
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
    if (each->sending_ >= 0) sendings_[static_cast<std::size_t>(each->sending_)]->cut = true;
    const SignalLoss loss = each->works() ? SignalLoss::out_of_water : SignalLoss::receiver_off;
    for (std::int64_t flight = each->receiver_.drop(); flight >= 0; flight = each->receiver_.drop())
      flights_[static_cast<std::size_t>(flight)].loss = loss;
  }
  watching_ = more;
  if (more) schedule(step_end_ + watch_period, watch_event, 0);
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
  flights_[static_cast<std::size_t>(number)] = {};
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
  sending.group = from.vehicle().group();
  sending.sequence = ++from.signals_;
  sending.sent = at;
  sending.users = 2;  // the two events
  schedule(at, emission_event, number);
  schedule(at + sending.signal.duration, emission_end_event, number);
}

void AcousticChannel::handle(const Event& event, Time now) {
  step_end_ = now;
  const int item = static_cast<int>(event.stamp.count());
  switch (event.kind) {
    case emission_event:
      emit(item, now);
      break;
    case emission_end_event:
      end_emission(item, event.due);
      break;
    case near_event:
      approach(item, event.due);
      break;
    case begin_event:
      begin(item);
      break;
    case end_event:
      end(item);
      break;
    case watch_event:
      watch();
      break;
    default:
      break;
  }
}

void AcousticChannel::emit(int number, Time now) {
  Sending& sending = *sendings_[static_cast<std::size_t>(number)];
  Transducer* from = sending.from;
  if (from == nullptr || !from->works() || !around_.medium.in_water(from->p_W(sending.sent))) {
    if (from != nullptr) ++from->counts_.unsent;
    release(number);
    return;
  }
  sending.p_W = from->p_W(sending.sent);
  sending.v_W = from->v_W();
  sending.R_WS = from->R_WS();
  sending.directivity = from->config().directivity;
  from->sending_ = number;
  if (!watching_) {
    watching_ = true;
    schedule(now + watch_period, watch_event, 0);
  }
  from->sending_until_ = std::max(from->sending_until_, sending.sent + sending.signal.duration);
  if (sending.signal.kind == Signal::Kind::message) {
    ++from->counts_.sent;
    from->counts_.sent_bytes += static_cast<std::int64_t>(sending.signal.payload.size());
  }
  for (std::int64_t flight = from->receiver_.drop(); flight >= 0; flight = from->receiver_.drop())
    flights_[static_cast<std::size_t>(flight)].loss = SignalLoss::half_duplex;

  const double reach_m = propagation_.audible_range_m(sending.signal, faintest(sending.signal.centre_Hz));
  if (neighbours_age_ < 0 || to_seconds(now) - neighbours_age_ > neighbours_hold_s) {
    std::vector<Neighbourhood::Member> members;
    for (const Transducer* each : transducers_)
      if (each != nullptr) members.push_back({each->number(), each->p_W(now)});
    neighbours_.build(members, reach_m);
    neighbours_age_ = to_seconds(now);
  }
  neighbours_.near(sending.p_W, reach_m + stray_m, near_);
  for (const int hearer : near_) {
    Transducer* to = transducers_[static_cast<std::size_t>(hearer)];
    if (to == nullptr || to == from) continue;
    const double distance_m = (to->p_W(sending.sent) - sending.p_W).norm();
    if (distance_m > reach_m + stray_m) continue;
    const int flight = new_flight();
    flights_[static_cast<std::size_t>(flight)].sending = number;
    flights_[static_cast<std::size_t>(flight)].to = to;
    ++sending.users;
    const double travel_s = travel_time_s(around_.medium, sending.p_W, to->p_W(sending.sent));
    schedule(sending.sent + from_seconds(travel_s * (1 - early)), near_event, flight);
  }
  release(number);
}

void AcousticChannel::end_emission(int number, Time at) {
  Sending& sending = *sendings_[static_cast<std::size_t>(number)];
  // It left the water meanwhile, or lost its power: the end of the signal is missing.
  Transducer* from = sending.from;
  if (from == nullptr || !from->works() || !around_.medium.in_water(from->p_W(at))) sending.cut = true;
  if (from != nullptr && from->sending_ == number) from->sending_ = -1;
  release(number);
}

void AcousticChannel::approach(int number, Time due) {
  Flight& flight = flights_[static_cast<std::size_t>(number)];
  if (flight.to != nullptr) {
    const Sending& sending = *sendings_[static_cast<std::size_t>(flight.sending)];
    // From here on the receiver goes on as it does now.
    const auto arrival =
        meeting(around_.medium, sending.p_W, sending.sent, flight.to->p_W(step_end_), step_end_, flight.to->v_W());
    if (arrival) {
      flight.travel_time_s = arrival->travel_time_s;
      flight.begun = std::max(due, sending.sent + from_seconds(arrival->travel_time_s));
      flight.p_begun_W = flight.to->p_W(flight.begun);
    } else {
      flight.to = nullptr;  // faster than sound: it was thrown out of the world
    }
  }
  schedule(std::max(flight.begun, due), begin_event, number);
}

PowerRatio AcousticChannel::noise_at(const Transducer& to, const Vector3d& p_W, const Signal& signal) const {
  const Decibels quieter = to.noise_reduction(signal.centre_Hz);
  PowerRatio noise = to_power(propagation_.ambient_level(signal.centre_Hz, signal.bandwidth_Hz) - quieter);
  for (const ContinuousSound* sound : sounds_) {
    if (!sound->on_ || !sound->vehicle_.systems().powered || sound->faults_.silent()) continue;
    const Vector3d from_W = sound->body_.X_WB() * sound->p_BS_;
    if (!around_.medium.in_water(from_W)) continue;
    const double f = sound->centre_Hz_, half_Hz = sound->bandwidth_Hz_ / 2;
    const double low_Hz = std::max(f - half_Hz, signal.centre_Hz - signal.bandwidth_Hz / 2);
    const double high_Hz = std::min(f + half_Hz, signal.centre_Hz + signal.bandwidth_Hz / 2);
    if (high_Hz <= low_Hz) continue;
    Decibels level = sound->source_level_ - propagation_.transmission_loss(from_W, p_W, f);
    level += directivity_gain(to.config().directivity, to.R_WS().transpose() * (from_W - p_W), f,
                              around_.medium.sound_speed_mps(p_W));
    if (config_.occlusion)
      level += pressure_level(
          propagation_.free_part(from_W, sound->vehicle_.group(), p_W, to.vehicle().group(), signal.centre_Hz));
    noise += (high_Hz - low_Hz) / sound->bandwidth_Hz_ * to_power(level);
  }
  return noise;
}

Decibels AcousticChannel::link_loss(const Transducer& to, const Sending& sending, double& loss_probability) const {
  const auto named = [](const std::string& name, const std::string& device) {
    return name.empty() || name == device ||
           (device.size() > name.size() && device[name.size()] == '/' && device.compare(0, name.size(), name) == 0);
  };
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
  // One for each pair, so that another modem in the world changes no other link.
  Random random(around_.seed, sending.source + ">" + to.full_name() + "#sound");
  random.begin_step(2 * sending.sequence + at_end);
  return random;
}

PowerRatio AcousticChannel::work_out_level(Flight& flight, const Sending& sending, double& later_s) {
  const Transducer& to = *flight.to;
  const Signal& signal = sending.signal;
  const Vector3d way_W = flight.p_begun_W - sending.p_W;
  const double range_m = way_W.norm();
  const Vector3d direction_W = range_m > 0 ? Vector3d(way_W / range_m) : Vector3d(Vector3d::UnitX());
  const Vector3d v_to_W = to.v_W();
  flight.closing_mps = closing_speed_mps(direction_W, sending.v_W, v_to_W);
  const double c = around_.medium.sound_speed_mps(flight.p_begun_W);
  const double squeezed = doppler_factor(direction_W, sending.v_W, v_to_W, c);
  flight.ended = flight.begun + from_seconds(to_seconds(signal.duration) / squeezed);

  Random random = stream(to, sending, false);
  const Propagation::Gain gain =
      propagation_.gain(sending.p_W, sending.group, flight.p_begun_W, to.vehicle().group(), signal.centre_Hz, random);
  double loss_probability = 0;
  Decibels level = signal.source_level - link_loss(to, sending, loss_probability);
  level += directivity_gain(sending.directivity, sending.R_WS.transpose() * direction_W, signal.centre_Hz, c);
  level += directivity_gain(to.config().directivity, -(to.R_WS().transpose() * direction_W), signal.centre_Hz, c);
  flight.level = level + gain.signal;
  later_s = gain.later_s;
  if (gain.blocked && gain.signal.dB() < lowest_dB) flight.loss = SignalLoss::blocked;
  return to_power(level) * gain.disturbing;
}

SignalLoss AcousticChannel::obstacle(const Flight& flight) const {
  const Transducer& to = *flight.to;
  if (!around_.medium.in_water(flight.p_begun_W)) return SignalLoss::out_of_water;
  if (!to.works()) return SignalLoss::receiver_off;
  if (flight.begun < to.sending_until_) return SignalLoss::half_duplex;
  if (std::abs(flight.closing_mps) > to.config().doppler_limit_mps) return SignalLoss::doppler;
  return flight.loss;  // blocked, or none
}

void AcousticChannel::begin(int number) {
  Flight& flight = flights_[static_cast<std::size_t>(number)];
  const Sending& sending = *sendings_[static_cast<std::size_t>(flight.sending)];
  if (flight.to == nullptr) {
    end(number);
    return;
  }
  Transducer& to = *flight.to;
  const Vector3d p_W = to.p_W(flight.begun);
  // Where it was expected, but for what its turns do in so short a time; somebody who was put elsewhere is met anew.
  if (!flight.delayed && (p_W - flight.p_begun_W).norm() > 0.01) {
    approach(number, flight.begun);
    return;
  }
  flight.p_begun_W = p_W;
  if (config_.range_max_m && (p_W - sending.p_W).norm() > *config_.range_max_m) {
    end(number);
    return;
  }
  double later_s = 0;
  const PowerRatio disturbing = work_out_level(flight, sending, later_s);
  if (later_s > 0 && !flight.delayed) {
    // Nothing comes along the direct path: the first sound is an echo.
    flight.delayed = true;
    flight.travel_time_s += later_s;
    flight.begun += from_seconds(later_s);
    schedule(flight.begun, begin_event, number);
    return;
  }
  flight.listened = to.listener_.listens_to(sending.signal);
  flight.present = flight.loss == SignalLoss::none && around_.medium.in_water(flight.p_begun_W);
  if (flight.present) {
    const PowerRatio power = to_power(flight.level) + disturbing;
    to.receiver_.begin({number, sending.signal.centre_Hz, sending.signal.bandwidth_Hz, power, flight.ended},
                       flight.begun);
  }
  if (flight.listened) take(number, flight, sending, disturbing);
  schedule(flight.ended, end_event, number);
}

void AcousticChannel::take(int number, Flight& flight, const Sending& sending, PowerRatio disturbing) {
  const Signal& signal = sending.signal;
  Transducer& to = *flight.to;
  TakenSignal taken;
  taken.sound = {number, signal.centre_Hz, signal.bandwidth_Hz, to_power(flight.level), flight.ended};
  taken.noise = noise_at(to, flight.p_begun_W, signal);
  taken.disturbing = disturbing;
  taken.modulation = signal.modulation;
  taken.bit_rate_bps = signal.bit_rate_bps;
  taken.bits = signal.bits;
  taken.coding_gain_dB = signal.coding_gain_dB;
  taken.begun = flight.begun;
  taken.ended = flight.ended;
  flight.snr = to_decibels(taken.sound.power / (taken.noise + disturbing));
  flight.loss = obstacle(flight);
  if (flight.loss != SignalLoss::none) return;
  std::int64_t displaced = -1;
  flight.loss = to.receiver_.take(taken, {to.config().detection_dB, to.config().capture_dB}, displaced);
  flight.noticed = flight.loss == SignalLoss::none;
  if (displaced >= 0) flights_[static_cast<std::size_t>(displaced)].loss = SignalLoss::captured;
}

void AcousticChannel::finish(Flight& flight, const Sending& sending, const SignalReceiver::Outcome& outcome) {
  Random random = stream(*flight.to, sending, true);
  const double luck = random.uniform();
  const double link_luck = random.uniform();
  if (luck > outcome.success) flight.loss = luck > outcome.success_alone ? SignalLoss::noise : SignalLoss::interference;
  double loss_probability = 0;
  link_loss(*flight.to, sending, loss_probability);
  if (flight.loss == SignalLoss::none && link_luck < loss_probability) flight.loss = SignalLoss::link;
}

void AcousticChannel::end(int number) {
  Flight& flight = flights_[static_cast<std::size_t>(number)];
  const Sending& sending = *sendings_[static_cast<std::size_t>(flight.sending)];
  if (Transducer* to = flight.to) {
    SignalReceiver::Outcome outcome;
    const bool taken = flight.present && to->receiver_.end(number, flight.ended, outcome);
    if (flight.listened) {
      Decibels sinr = flight.snr;
      if (taken) {
        sinr = to_decibels(outcome.worst_sinr);
        finish(flight, sending, outcome);
        if (!around_.medium.in_water(to->p_W(flight.ended)) || sending.cut) flight.loss = SignalLoss::out_of_water;
        if (!to->works()) flight.loss = SignalLoss::receiver_off;
      }
      const bool message = sending.signal.kind == Signal::Kind::message;
      if (message) ++to->counts_.lost[static_cast<std::size_t>(flight.loss)];
      if (message && flight.loss == SignalLoss::none) {
        ++to->counts_.understood;
        to->counts_.understood_bytes += static_cast<std::int64_t>(sending.signal.payload.size());
      }
      const bool deaf = flight.loss == SignalLoss::receiver_off || flight.loss == SignalLoss::out_of_water ||
                        flight.loss == SignalLoss::blocked;
      if (!deaf)
        to->listener_.heard({sending.signal, sending.source, sending.number, sending.sent, flight.begun, flight.ended,
                             flight.travel_time_s, sending.p_W, flight.p_begun_W, flight.level, flight.snr, sinr,
                             flight.closing_mps, flight.loss, flight.noticed});
    }
  }
  // heard() may have transmitted: references are stale.
  const int of = flights_[static_cast<std::size_t>(number)].sending;
  free_flights_.push_back(number);
  flights_[static_cast<std::size_t>(number)] = {};
  release(of);
}

void AcousticChannel::hash_state(StateHash& hash) const {
  if (transducers_.empty()) return;
  for (const Transducer* transducer : transducers_)
    if (transducer != nullptr) transducer->hash_state(hash);
  for (const ContinuousSound* sound : sounds_) {
    hash.add(sound->on_);
    hash.add(sound->source_level_.dB());
  }
  for (const auto& sending : sendings_) {
    hash.add(sending->sequence);
    hash.add(static_cast<std::int64_t>(sending->sent.count()));
    hash.add(sending->p_W);
    hash.add(sending->cut);
    hash.add_bytes(sending->signal.payload.data(), sending->signal.payload.size());
  }
  for (const Flight& flight : flights_) {
    hash.add(flight.sending);
    hash.add(static_cast<std::int64_t>(flight.begun.count()));
    hash.add(static_cast<std::int64_t>(flight.ended.count()));
    hash.add(flight.to != nullptr ? flight.to->number() : -1);
    hash.add(flight.travel_time_s);
    hash.add(flight.level.dB());
    hash.add(static_cast<int>(flight.loss));
    hash.add(flight.present);
    hash.add(flight.noticed);
  }
}

}  // namespace sim
