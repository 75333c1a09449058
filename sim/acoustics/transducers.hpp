// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/acoustics/transducer.hpp"
#include "sim/base/free_numbers.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// The transducers of a world, which belong to devices.  This class owns
/// - the list of them by number, in device order, and which numbers are free.  The lowest is used next, so that the
///   same history of additions and removals gives the same numbers; a snapshot prescribes those of what it adds,
/// - the serial number of the last registration, which tells a transducer from a removed one of the same number,
/// - the counts of those that were removed.
///
/// It does not know signals: the channel notifies Transmissions, Flights and ReceiverSearch of what is added or
/// removed.  Threads that handle events at different receivers only read the list.
class Transducers {
 public:
  void add(Transducer& transducer);
  /// Removes a transducer and adds its counts to counts_of_removed().
  void remove(Transducer& transducer);
  /// By number; null where one was removed.
  const std::vector<Transducer*>& all() const { return transducers_; }
  int count() const { return static_cast<int>(transducers_.size()); }
  Transducer* at(int number) const { return transducers_[static_cast<std::size_t>(number)]; }
  /// Null when there is none, or it was removed.
  Transducer* find(const TransducerRef& of) const {
    Transducer* const found = of.number < 0 ? nullptr : at(of.number);
    return found != nullptr && found->ref() == of ? found : nullptr;
  }
  /// Calls visit(transducer) for each, ascending.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (Transducer* each : transducers_)
      if (each != nullptr) visit(*each);
  }
  /// Whether one of them has this address.
  bool any_has(const Audience& address) const;
  const Transducer::Counts& counts_of_removed() const { return removed_; }

  /// Sets the numbers of the next transducers, in this order.  Throws std::out_of_range when one is invalid or in use.
  void prescribe(const std::vector<int>& numbers) { numbers_.prescribe(numbers); }
  bool as_prescribed() const { return numbers_.as_prescribed(); }

  /// Visits a reference by its number; null: -1.  Returns the restored one.
  Transducer* visit_reference(StateArchive& archive, const Transducer* transducer) const;
  /// Visits the state of each, which their devices do not visit.
  void visit_each(StateArchive& archive);
  void visit_removed(StateArchive& archive) { archive.unhashed(removed_); }

 private:
  std::vector<Transducer*> transducers_;
  FreeNumbers numbers_;
  std::uint32_t registrations_ = 0;
  Transducer::Counts removed_;
};

}  // namespace sim
