// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "sim/acoustics/neighborhood.hpp"
#include "sim/acoustics/propagation/acoustics_config.hpp"
#include "sim/acoustics/propagation/propagation.hpp"
#include "sim/acoustics/transducers.hpp"
#include "sim/acoustics/transmissions.hpp"
#include "sim/medium/medium.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Search for the transducers that a transmission may reach.  This class owns
/// - a grid of the transducers by their place, which is valid for a second of simulated time,
/// - the depth of the lowest transducer at that time, as the loss by absorption depends on depth,
/// - by frequency, how far below the noise a signal still affects any receiver.
///
/// update_range() comes before each receivers(): it renews what is outdated.  Call discard_places() after a transducer
/// was moved otherwise than by its motion, and discard_all() after one was added, removed or changed.
///
/// The range is an upper bound, so that what is found depends on the state only.  A second is short enough for a bound
/// of how far a transducer moves in it.  Grid and time are saved, so that a continued run searches as the original did.
class ReceiverSearch {
 public:
  /// The arguments must outlive the object.
  ReceiverSearch(const AcousticsConfig& config, const Medium& medium, const Propagation& propagation,
                 const Transducers& transducers)
      : config_(config), medium_(medium), propagation_(propagation), transducers_(transducers) {}

  /// Returns the distance from the sender within which transducers may receive a signal, m.
  double update_range(const Signal& signal, Time now);
  /// The transducers within this distance of a transmission at its start, ascending, except its sender.  Valid until
  /// the next call.
  const std::vector<Transducer*>& receivers(const Transmission& transmission, double range_m);
  void discard_places() { searched_at_s_ = -1; }
  void discard_all() {
    min_levels_.clear();
    discard_places();
  }
  /// Number of transducers examined since the start: a measure of the work.
  std::int64_t examined() const { return examined_; }

  void visit_state(StateArchive& archive);
  /// Checks restored numbers.
  void check(const StateArchive& archive) const;

 private:
  Decibels min_level(double frequency_Hz);
  Decibels compute_min_level(double frequency_Hz);

  const AcousticsConfig& config_;
  const Medium& medium_;
  const Propagation& propagation_;
  const Transducers& transducers_;
  Neighborhood places_;
  double searched_at_s_ = -1;  // time at which places_ was built; negative: never
  double lowest_m_ = 0;        // z of the lowest transducer at that time
  std::vector<std::pair<double, Decibels>> min_levels_;
  std::vector<int> near_;
  std::vector<Transducer*> receivers_;
  std::int64_t examined_ = 0;
};

}  // namespace sim
