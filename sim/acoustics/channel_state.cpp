// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "sim/acoustics/channel.hpp"
#include "sim/base/record_hash.hpp"

// The state of the channel, for hashes and snapshots.

namespace sim {

namespace {

/// Checks a loss, which is used as an index of counts.
void check_loss(SignalLoss loss, const StateArchive& archive) {
  if (static_cast<int>(loss) < 0 || static_cast<int>(loss) >= signal_losses)
    archive.fail("a signal lost for an unknown cause");
}

}  // namespace

void AcousticChannel::Sending::visit_state(StateArchive& archive) {
  archive(signal, source, number, group, sequence, sent, p_W, v_W, R_WS, cut, cut_after, users);
  archive.unhashed(directivity.pattern, directivity.diameter_m, directivity.length_m, directivity.floor_dB);
  if (!archive.restoring()) return;
  check_loss(cut, archive);
  if (cut_after < Time{0} || cut_after > std::max(signal.duration, Time{0}))
    archive.fail("a signal cut beyond its end");
}

void AcousticChannel::Flight::visit_state(StateArchive& archive) {
  archive(sending, started, ended, travel_time_s, p_started_W, closing_mps, level, snr, loss, listened, present,
          detected, delayed, meant);
  // Functions of the positions and the seed, without an effect before the end of the signal.
  archive.unhashed(shadow, bent, arrives_W, lock_later_s);
  if (archive.restoring()) check_loss(loss, archive);
}

/// Visits a transducer by its number; -1: null.  Returns the restored one.
Transducer* AcousticChannel::visit_transducer(StateArchive& archive, const Transducer* transducer) {
  int number = transducer != nullptr ? transducer->number() : -1;
  archive(number);
  if (number >= static_cast<int>(transducers_.size())) archive.fail("a signal of a transducer that does not exist");
  return number < 0 ? nullptr : transducers_[static_cast<std::size_t>(number)];
}

void AcousticChannel::visit_state(StateArchive& archive) {
  // Transducers and continuous sounds.
  for (Transducer* transducer : transducers_)
    if (transducer != nullptr) archive(*transducer);
  for (ContinuousSound* sound : sounds_) archive(*sound);
  // Transmissions and flights.
  auto sendings = static_cast<std::uint64_t>(sendings_.size()), flights = static_cast<std::uint64_t>(flights_.size());
  archive(sendings, flights);
  if (archive.restoring()) {
    sendings_.clear();
    flights_.clear();
  }
  // Grow the lists while reading, so that a wrong count allocates no memory.
  for (std::uint64_t i = 0; i < sendings; ++i) {
    if (archive.restoring()) sendings_.push_back(std::make_unique<Sending>());
    archive(*sendings_[i]);
    Transducer* const from = visit_transducer(archive, sendings_[i]->from);
    if (archive.restoring()) sendings_[i]->from = from;
  }
  for (std::uint64_t i = 0; i < flights; ++i) {
    if (archive.restoring()) flights_.emplace_back();
    archive(flights_[i]);
    const Transducer* const to = visit_transducer(archive, receiver_of(flights_[i]));
    if (!archive.restoring()) continue;
    set_receiver(flights_[i], to);
    const int sending = flights_[i].sending;
    if (sending >= 0 && static_cast<std::size_t>(sending) < sendings_.size())
      sendings_[static_cast<std::size_t>(sending)]->flights.push_back(static_cast<int>(i));
  }
  if (archive.restoring()) {
    ++polls_;
    sum_outdated_ = true;
    // Of a step that failed.
    deferred_.clear();
    deferred_at_.clear();
    receivers_.clear();
    // Bands are added to a cache, which threads must not do.
    for (const auto& sending : sendings_)
      propagation_.ambient_level(sending->signal.centre_Hz, sending->signal.bandwidth_Hz);
  }
  // Free lists, neighbors and counts.
  archive.unhashed(free_sendings_, free_flights_, flights_made_, step_end_, neighbors_, neighbors_age_);
  if (!archive.hashing()) archive.not_only_finite(lowest_m_);  // infinity: without a receiver
  archive.unhashed(messages_, watching_, removed_, shadow_losses_);
  if (archive.restoring()) check_numbers(archive);
}

std::uint64_t AcousticChannel::hash_of(int number, const Flight& flight) const {
  const bool flags[] = {flight.listened, flight.present, flight.detected, flight.delayed, flight.meant};
  int all_flags = 0;
  for (const bool flag : flags) all_flags = all_flags << 1 | static_cast<int>(flag);
  const Transducer* const to = receiver_of(flight);
  const Vector3d& p_W = flight.p_started_W;
  return record_hash({word_of(number, flight.sending), word_of(to != nullptr ? to->number() : -1, all_flags),
                      static_cast<std::uint64_t>(flight.started.count()),
                      static_cast<std::uint64_t>(flight.ended.count()), word_of(flight.travel_time_s),
                      word_of(flight.closing_mps), word_of(p_W.x()), word_of(p_W.y()), word_of(p_W.z()),
                      word_of(flight.level.dB()), word_of(flight.snr.dB()), static_cast<std::uint64_t>(flight.loss)});
}

void AcousticChannel::update_hash(int number, std::uint64_t& sum) {
  Flight& flight = flights_[static_cast<std::size_t>(number)];
  sum -= flight.hash;
  flight.hash = hash_of(number, flight);
  sum += flight.hash;
}

std::uint64_t AcousticChannel::content_hash() {
  if (std::exchange(sum_outdated_, false)) {
    flights_sum_ = 0;
    for (std::size_t i = 0; i < flights_.size(); ++i) {
      flights_[i].hash = 0;
      if (flights_[i].sending >= 0) update_hash(static_cast<int>(i), flights_sum_);
    }
  }
  StateArchive hash = StateArchive::quick_hasher();
  for (Transducer* transducer : transducers_)
    if (transducer != nullptr) transducer->add_content(hash);
  for (ContinuousSound* sound : sounds_) hash(*sound);
  for (const auto& sending : sendings_) {
    hash(*sending);
    visit_transducer(hash, sending->from);
  }
  auto flights = static_cast<std::uint64_t>(flights_.size() - free_flights_.size());
  hash(flights, flights_sum_);
  return hash.hash();
}

namespace {

[[noreturn]] void fail_for_signal(const StateArchive& archive) {
  archive.fail("a signal that does not exist");
}

/// Returns which of `count` items are in use.  Fails when an item is free twice.
std::vector<char> in_use(const std::vector<int>& free, std::size_t count, const StateArchive& archive) {
  std::vector<char> used(count, 1);
  for (const int number : free) {
    if (number < 0 || static_cast<std::size_t>(number) >= count) fail_for_signal(archive);
    if (!std::exchange(used[static_cast<std::size_t>(number)], 0)) archive.fail("a signal that is freed twice");
  }
  return used;
}

}  // namespace

/// Checks all restored numbers that are used as indices.
void AcousticChannel::check_numbers(const StateArchive& archive) const {
  const std::vector<char> sending_used = in_use(free_sendings_, sendings_.size(), archive);
  const std::vector<char> flight_used = in_use(free_flights_, flights_.size(), archive);
  const auto sends = [&](int number) {
    return number >= 0 && static_cast<std::size_t>(number) < sendings_.size() &&
           sending_used[static_cast<std::size_t>(number)];
  };
  for (std::size_t i = 0; i < flights_.size(); ++i)
    if (flight_used[i] && !sends(flights_[i].sending)) fail_for_signal(archive);
  for (const Transducer* each : transducers_) {
    if (each == nullptr) continue;
    const bool in_range = each->sending_ >= -1 && each->sending_ < static_cast<int>(sendings_.size());
    if (!in_range || !each->receiver_.flights_are_below(flights_.size())) fail_for_signal(archive);
  }
  // Numbers of removed transducers stay in the list until it is rebuilt, which a negative age requests.
  const bool in_use_now = !(neighbors_age_ < 0);
  if (in_use_now && !neighbors_.numbers_are_below(transducers_.size())) archive.fail("a neighbor that does not exist");
}

/// Checks that each signal in use has exactly the events and flights that it counts, and each flight one event;
/// otherwise a signal could be released while it is still needed.
void AcousticChannel::check_events(std::span<const Event> events, const StateArchive& archive) const {
  std::vector<int> users(sendings_.size(), 0), flight_events(flights_.size(), 0);
  const std::vector<char> flight_used = in_use(free_flights_, flights_.size(), archive);
  for (std::size_t i = 0; i < flights_.size(); ++i)
    if (flight_used[i]) ++users[static_cast<std::size_t>(flights_[i].sending)];
  for (const Event& event : events) {
    if (event.device != Event::of_acoustics) continue;
    const bool of_sending = event.kind == emission_event || event.kind == emission_end_event;
    const bool of_flight = event.kind == near_event || event.kind == start_event || event.kind == end_event;
    const bool of_silence = event.kind == silence_event;
    if (!of_sending && !of_flight && !of_silence) continue;
    std::vector<int>& counts = of_sending ? users : flight_events;
    const std::int64_t item = event.stamp.count();
    if (item < 0 || static_cast<std::uint64_t>(item) >= counts.size()) fail_for_signal(archive);
    counts[static_cast<std::size_t>(item)] += !of_silence;
  }
  const std::vector<char> sending_used = in_use(free_sendings_, sendings_.size(), archive);
  for (std::size_t i = 0; i < sendings_.size(); ++i)
    if (users[i] != (sending_used[i] ? sendings_[i]->users : 0)) archive.fail("a signal whose users do not exist");
  for (std::size_t i = 0; i < flights_.size(); ++i)
    if (flight_events[i] != flight_used[i]) archive.fail("a signal in flight that never arrives, or arrives twice");
}

}  // namespace sim
