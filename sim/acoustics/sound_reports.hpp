// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/acoustics/flights.hpp"
#include "sim/acoustics/sound_observer.hpp"
#include "sim/acoustics/transducers.hpp"
#include "sim/acoustics/transmissions.hpp"
#include "sim/medium/medium.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Message that a shadow took from its addressee.
struct ShadowLoss {
  Time sent{0};
  std::string source, receiver;  ///< vehicle and device
  double range_m = 0;
  void visit_state(StateArchive& archive) { archive(sent, source, receiver, range_m); }
};

/// Reports of transmissions and their results.  This class owns
/// - the reference to an observer, if any: a live page or a record,
/// - the first messages lost in shadows, for the summary of a run.
///
/// The channel calls transmitted() at the start of a transmission, when its flights exist, and arrived() when a flight
/// ended, before its listener is notified.  Nothing depends on the reports, so that they are not hashed; the messages
/// lost in shadows are saved.
class SoundReports {
 public:
  SoundReports(const Medium& medium, const Transducers& transducers) : medium_(medium), transducers_(transducers) {}

  /// Null: none.
  void set_observer(SoundObserver* observer) { observer_ = observer; }
  /// Reports a transmission, and the addressees that are beyond its range.
  void transmitted(const Transmission& transmission, double range_m) const;
  /// Reports the result of a flight if the receiver listened, or it was an addressee beyond the maximum range.
  void arrived(const Flight& flight, const Transmission& transmission, const Transducer& to);

  static constexpr std::size_t max_shadow_losses = 100;
  const std::vector<ShadowLoss>& shadow_losses() const { return shadow_losses_; }
  void visit_state(StateArchive& archive) { archive.unhashed(shadow_losses_); }

 private:
  const Medium& medium_;
  const Transducers& transducers_;
  SoundObserver* observer_ = nullptr;
  std::vector<ShadowLoss> shadow_losses_;
};

}  // namespace sim
