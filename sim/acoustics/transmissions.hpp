// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "sim/acoustics/numbered_pool.hpp"
#include "sim/acoustics/propagation/directivity.hpp"
#include "sim/acoustics/propagation/signal.hpp"
#include "sim/acoustics/transducers.hpp"
#include "sim/base/math.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Signal that is scheduled, being transmitted, or on its way.
struct Transmission {
  Signal signal;
  Transducer* from = nullptr;  ///< null: removed, or canceled before its start
  std::string source;          ///< full name of the sender
  int number = -1;             ///< of the sender
  int group = -1;              ///< of the sender
  std::int64_t sequence = 0;   ///< of the sender's signals
  Time sent{0};
  Vector3d p_W = Vector3d::Zero(), v_W = Vector3d::Zero();  ///< of the sender at `sent`
  Matrix3d R_WS = Matrix3d::Identity();
  DirectivityConfig directivity;
  SignalLoss truncated_by = SignalLoss::none;
  Time truncated_after{0};        ///< duration transmitted until then
  int users = 0;                  ///< flights and events that refer to it
  std::vector<FlightId> flights;  ///< all that were made; ids of ended ones may have other signals now

  bool truncated() const { return truncated_by != SignalLoss::none; }
  void visit_state(StateArchive& archive);  ///< except `from` and `flights`
};

/// All transmissions of a world that are scheduled or have flights.  This class owns
/// - the transmissions by number, each until the last event or flight that refers to it ends.
///
/// Life of a transmission:
/// 1. add(), with two users: the events of its start and its end,
/// 2. before its start cancel_pending() may take its sender, so that nothing is transmitted,
/// 3. at its start AcousticChannel sets pose and velocity of the sender, and adds a flight, one more user, for each
///    receiver in range,
/// 4. truncate() if the sender fails before the end,
/// 5. release() by each event and each flight; the last one removes it.
///
/// References stay valid while others are added: a listener that gets a signal may transmit.  Threads only read.
class Transmissions {
 public:
  TransmissionId add(Transducer& from, std::int64_t sequence, Signal signal, Time at);
  Transmission& operator[](TransmissionId id) { return pool_[id]; }
  const Transmission& operator[](TransmissionId id) const { return pool_[id]; }
  std::size_t size() const { return pool_.size(); }
  bool contains(std::int64_t number) const { return pool_.contains(number); }
  /// Ends one use.
  void release(TransmissionId id);
  /// Cancels all transmissions of a transducer except `present`.
  void cancel_pending(const Transducer& from, TransmissionId present);
  /// Ends a transmission at a time, which is limited to its duration.
  void truncate(TransmissionId id, SignalLoss why, Time at);

  /// Visits `count` transmissions, the number saved, without their flights.
  void visit_items(StateArchive& archive, std::uint64_t count, const Transducers& transducers);
  void visit_free(StateArchive& archive) { pool_.visit_free(archive); }
  std::vector<char> used(const StateArchive& archive) const { return pool_.used(archive); }
  template <typename Visit>
  void for_each(const Visit& visit) const {
    pool_.for_each(visit);
  }

 private:
  NumberedPool<Transmission, std::deque<Transmission>> pool_;
};

}  // namespace sim
