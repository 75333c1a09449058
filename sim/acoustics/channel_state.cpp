#include "sim/acoustics/channel.hpp"

// The state of the channel, for hashes and snapshots.

namespace sim {

void AcousticChannel::Sending::visit_state(StateArchive& archive) {
  archive(signal, source, number, group, sequence, sent, p_W, v_W, R_WS, cut, users);
  archive.unhashed(directivity.pattern, directivity.diameter_m, directivity.length_m, directivity.floor_dB);
}

void AcousticChannel::Flight::visit_state(StateArchive& archive) {
  archive(sending, begun, ended, travel_time_s, p_begun_W, closing_mps, level, snr, loss, listened, present, noticed,
          delayed);
}

/// By its number; -1: null.
void AcousticChannel::visit_transducer(StateArchive& archive, Transducer*& transducer) {
  int number = transducer != nullptr ? transducer->number() : -1;
  archive(number);
  if (!archive.restoring()) return;
  if (number >= static_cast<int>(transducers_.size())) archive.fail("a signal of a transducer that is not there");
  transducer = number < 0 ? nullptr : transducers_[static_cast<std::size_t>(number)];
}

void AcousticChannel::visit_state(StateArchive& archive) {
  for (Transducer* transducer : transducers_)
    if (transducer != nullptr) archive(*transducer);
  for (ContinuousSound* sound : sounds_) archive(*sound);
  auto sendings = static_cast<std::uint64_t>(sendings_.size()), flights = static_cast<std::uint64_t>(flights_.size());
  archive(sendings, flights);
  if (archive.restoring()) {
    constexpr std::uint64_t most = 1 << 24;
    if (sendings > most || flights > most) archive.fail("more signals than there can be");
    sendings_.resize(sendings);
    for (auto& sending : sendings_) sending = std::make_unique<Sending>();
    flights_.assign(flights, {});
  }
  for (const auto& sending : sendings_) {
    archive(*sending);
    visit_transducer(archive, sending->from);
  }
  for (Flight& flight : flights_) {
    archive(flight);
    visit_transducer(archive, flight.to);
  }
  archive.unhashed(free_sendings_, free_flights_, flights_made_, step_end_, neighbours_, neighbours_age_, watching_,
                   gone_);
  if (archive.restoring()) check_numbers(archive);
}

/// Numbers that are used to look things up.
void AcousticChannel::check_numbers(const StateArchive& archive) const {
  const auto check = [&](std::int64_t number, std::size_t count) {
    if (number < -1 || number >= static_cast<std::int64_t>(count)) archive.fail("a signal that is not there");
  };
  for (const int number : free_sendings_) check(number, sendings_.size());
  for (const int number : free_flights_) check(number, flights_.size());
  for (const Flight& flight : flights_) check(flight.sending, sendings_.size());
  for (const Transducer* transducer : transducers_)
    if (transducer != nullptr) check(transducer->sending_, sendings_.size());
}

}  // namespace sim
