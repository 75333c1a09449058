// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/flights.hpp"

#include <utility>

#include "sim/base/record_hash.hpp"

namespace sim {

void Flight::visit_state(StateArchive& archive) {
  archive(transmission, started, ended, travel_time_s, p_started_W, closing_mps, level, snr, loss, listened, present,
          detected, delayed, addressed);
  // Functions of the positions and the seed, without an effect before the end of the signal.
  archive.unhashed(shadow, bent, arrives_W, lock_later_s);
  if (archive.restoring()) check_loss(loss, archive);
}

std::uint64_t Flights::hash_of(FlightId id) const {
  const Flight& flight = pool_[id];
  const bool flags[] = {flight.listened, flight.present, flight.detected, flight.delayed, flight.addressed};
  int all_flags = 0;
  for (const bool flag : flags) all_flags = all_flags << 1 | static_cast<int>(flag);
  const Transducer* const to = receiver(flight);
  const Vector3d& p_W = flight.p_started_W;
  return record_hash(
      {word_of(id.number, flight.transmission.number), word_of(to != nullptr ? to->number() : -1, all_flags),
       static_cast<std::uint64_t>(flight.started.count()), static_cast<std::uint64_t>(flight.ended.count()),
       word_of(flight.travel_time_s), word_of(flight.closing_mps), word_of(p_W.x()), word_of(p_W.y()), word_of(p_W.z()),
       word_of(flight.level.dB()), word_of(flight.snr.dB()), static_cast<std::uint64_t>(flight.loss)});
}

void Flights::update_hash(FlightId id, std::uint64_t& change) {
  Flight& flight = pool_[id];
  change -= flight.hash;
  flight.hash = hash_of(id);
  change += flight.hash;
}

void Flights::add_content(StateArchive& hash) {
  if (std::exchange(sum_outdated_, false)) {
    sum_ = 0;
    pool_.for_each([&](FlightId id, Flight& flight) {
      flight.hash = 0;
      if (flight.transmission.valid()) update_hash(id);
    });
  }
  auto count = static_cast<std::uint64_t>(pool_.in_use());
  hash(count, sum_);
}

void Flights::visit_items(StateArchive& archive, std::uint64_t count, Transmissions& transmissions) {
  pool_.visit_items(archive, count, [&](FlightId id, Flight& flight) {
    archive(flight);
    const Transducer* const to = transducers_.visit_reference(archive, receiver(flight));
    if (!archive.restoring()) return;
    flight.set_receiver(to);
    if (transmissions.contains(flight.transmission.number)) transmissions[flight.transmission].flights.push_back(id);
  });
  if (archive.restoring()) sum_outdated_ = true;
}

}  // namespace sim
