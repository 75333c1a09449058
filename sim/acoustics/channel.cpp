#include "sim/acoustics/channel.hpp"

#include <algorithm>
#include <cmath>
#include <set>

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
  forget_places();
}

bool AcousticChannel::prescribe(std::vector<int> numbers) {
  constexpr int most = 10'000'000;
  for (const int number : numbers) {
    const auto at = static_cast<std::size_t>(number);
    if (number < 0 || number >= most || (at < transducers_.size() && transducers_[at] != nullptr)) return false;
  }
  if (std::set<int>(numbers.begin(), numbers.end()).size() != numbers.size()) return false;
  std::reverse(numbers.begin(), numbers.end());
  prescribed_ = std::move(numbers);
  return true;
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
    Transducer* const to = flight.noticed ? receiver_of(flight) : nullptr;
    if (to == nullptr || !to->receiver_.takes(number)) continue;
    const Signal& signal = sendings_[static_cast<std::size_t>(flight.sending)]->signal;
    const PowerRatio noise = noise_at(*to, to->p_W(around_.medium.now()), signal);
    to->receiver_.set_noise(number, noise, around_.medium.now());
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

void AcousticChannel::set_receiver(Flight& flight, const Transducer* to) {
  flight.to = to != nullptr ? to->number() : -1;
  flight.to_join = to != nullptr ? to->join_ : 0;
}

/// With many signals under way each one is far from the last in memory.
void AcousticChannel::fetch_ahead() const {
  constexpr std::size_t events_ahead = 6;
  const std::optional<Time> item = around_.events.stamp_ahead(events_ahead, Event::of_acoustics);
  if (!item || item->count() < 0 || static_cast<std::uint64_t>(item->count()) >= flights_.size()) return;
  const Flight* const flight = &flights_[static_cast<std::size_t>(item->count())];
  __builtin_prefetch(flight, 1);
  __builtin_prefetch(reinterpret_cast<const char*>(flight + 1) - 1, 1);
}

void AcousticChannel::handle(const Event& event, Time now) {
  if (now != step_end_) ++looks_;
  step_end_ = now;
  handling_ = true;
  fetch_ahead();
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
  handling_ = false;
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
    const Vector3d p_W = to->p_W(sending.sent);
    if ((p_W - sending.p_W).norm() > reach_m + stray_m) continue;
    const int flight = new_flight();
    flights_[static_cast<std::size_t>(flight)].sending = number;
    set_receiver(flights_[static_cast<std::size_t>(flight)], to);
    ++sending.users;
    const double travel_s = travel_time_s(around_.medium, sending.p_W, p_W);
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
  if (const Transducer* const to = receiver_of(flight)) {
    const Sending& sending = *sendings_[static_cast<std::size_t>(flight.sending)];
    // From here on the receiver goes on as it does now.
    const auto arrival = meeting(around_.medium, sending.p_W, sending.sent, to->p_W(step_end_), step_end_, to->v_W());
    if (arrival) {
      flight.travel_time_s = arrival->travel_time_s;
      flight.begun = std::max(due, sending.sent + from_seconds(arrival->travel_time_s));
      flight.p_begun_W = to->p_W(flight.begun);
    } else {
      set_receiver(flight, nullptr);  // faster than sound: it was thrown out of the world
    }
  }
  schedule(std::max(flight.begun, due), begin_event, number);
}

}  // namespace sim
