// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/acoustics/numbered_pool.hpp"
#include "sim/acoustics/transducers.hpp"
#include "sim/acoustics/transmissions.hpp"
#include "sim/base/math.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Propagation of a transmission to one receiver, from its start until it ends there.
struct Flight {
  TransmissionId transmission;
  TransducerRef to;  ///< none: removed
  SignalLoss loss = SignalLoss::none;
  Time started{0}, ended{0};  ///< at the receiver
  double travel_time_s = 0;
  Vector3d p_started_W = Vector3d::Zero();  ///< of the receiver
  double closing_mps = 0;
  Decibels level{0}, snr{0};
  bool listened = false;                  ///< the receiver tries to decode it
  bool present = false;                   ///< it is a sound at the receiver
  bool detected = false;                  ///< the receiver locked on to it
  bool delayed = false;                   ///< the first arrival is an echo
  bool addressed = false;                 ///< to the receiver
  bool shadow = false;                    ///< no ray without a bounce reaches the receiver
  bool bent = false;                      ///< arrives_W is that of a ray
  Vector3d arrives_W = Vector3d::Zero();  ///< unit vector along the sound at the receiver
  double lock_later_s = 0;                ///< delay of the echo that the receiver takes for the first arrival
  std::uint64_t hash = 0;                 ///< as in the sum of Flights
  void set_receiver(const Transducer* receiver) { to = receiver != nullptr ? receiver->ref() : TransducerRef{}; }
  void visit_state(StateArchive& archive);  ///< except `to`
};

/// All signals on their way to receivers.  This class owns
/// - the flights by number, and how many there were,
/// - the sum of their hashes, which is kept up to date: with a million signals in flight, hashing all of them would
/// take
///   longer than many steps.
///
/// Whoever changes a flight calls update_hash() when the change is complete.  Threads that handle events at different
/// receivers change different flights, and sum the changes of hashes for themselves, for add_to_sum() later.  The hash
/// includes whether the receiver exists: discard_sum() when a transducer was removed.
class Flights {
 public:
  explicit Flights(const Transducers& transducers) : transducers_(transducers) {}

  FlightId add() {
    ++made_;
    return pool_.add();
  }
  void remove(FlightId id) {
    sum_ -= pool_[id].hash;
    pool_.remove(id);
  }
  Flight& operator[](FlightId id) { return pool_[id]; }
  const Flight& operator[](FlightId id) const { return pool_[id]; }
  std::size_t size() const { return pool_.size(); }
  bool contains(std::int64_t number) const { return pool_.contains(number); }
  /// Calls visit(id, flight) for each, also for numbers that are free, in which the transmission is none.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    pool_.for_each(visit);
  }
  /// Receiver of a flight; null when it was removed.
  Transducer* receiver(FlightId id) const { return receiver(pool_[id]); }
  Transducer* receiver(const Flight& flight) const { return transducers_.find(flight.to); }
  /// Number since the start.
  std::int64_t made() const { return made_; }

  void update_hash(FlightId id) { update_hash(id, sum_); }
  /// The same for a thread: adds the change to `change`.
  void update_hash(FlightId id, std::uint64_t& change);
  void add_to_sum(std::uint64_t change) { sum_ += change; }
  void discard_sum() { sum_outdated_ = true; }
  /// Adds number and content of all flights to a hash.
  void add_content(StateArchive& hash);

  /// Visits `count` flights, the number saved.  Restoring adds each to its transmission.
  void visit_items(StateArchive& archive, std::uint64_t count, Transmissions& transmissions);
  void visit_free(StateArchive& archive) { pool_.visit_free(archive); }
  void visit_made(StateArchive& archive) { archive.unhashed(made_); }
  std::vector<char> used(const StateArchive& archive) const { return pool_.used(archive); }

 private:
  std::uint64_t hash_of(FlightId id) const;

  const Transducers& transducers_;
  NumberedPool<Flight> pool_;
  std::int64_t made_ = 0;
  std::uint64_t sum_ = 0;  // of the hashes of the flights in use
  bool sum_outdated_ = false;
};

}  // namespace sim
