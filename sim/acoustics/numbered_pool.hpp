// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim/state/state_archive.hpp"

namespace sim {

/// Number of a T in a pool; negative: none.  A separate type, so that it is not an index of another list.
template <typename T>
struct Id {
  int number = -1;
  bool valid() const { return number >= 0; }
  bool operator==(const Id&) const = default;
  void visit_state(StateArchive& archive) { archive(number); }
};

/// Value of an object in a list by number.
template <typename List, typename T>
auto& at(List& list, Id<T> id) {
  return list[static_cast<std::size_t>(id.number)];
}

struct Transmission;
struct Flight;
using TransmissionId = Id<Transmission>;
using FlightId = Id<Flight>;

/// Objects that are added and removed by the million.  This class owns
/// - the objects, by number, in a List: a std::vector, or a std::deque if references to them must stay valid,
/// - the numbers that are free.  The one released last is used next, since its memory is still in the cache.
///
/// A number thus depends on the order of all releases (FreeNumbers, which takes the lowest, costs more).  It is part of
/// the state, as the numbers are: a snapshot has the free objects too, and the list of free numbers.
template <typename T, typename List = std::vector<T>>
class NumberedPool {
 public:
  Id<T> add() {
    if (free_.empty()) {
      free_.push_back(static_cast<int>(items_.size()));
      items_.emplace_back();
    }
    const int number = free_.back();
    free_.pop_back();
    return {number};
  }
  void remove(Id<T> id) {
    free_.push_back(id.number);
    (*this)[id] = {};
  }
  T& operator[](Id<T> id) { return at(items_, id); }
  const T& operator[](Id<T> id) const { return at(items_, id); }
  /// Number of objects, with the free ones.
  std::size_t size() const { return items_.size(); }
  std::size_t in_use() const { return items_.size() - free_.size(); }
  bool contains(std::int64_t number) const { return number >= 0 && static_cast<std::uint64_t>(number) < items_.size(); }
  /// Calls visit(id, object) for each object, with the free ones.
  template <typename Visit>
  void for_each(const Visit& visit) {
    for (std::size_t i = 0; i < items_.size(); ++i) visit(Id<T>{static_cast<int>(i)}, items_[i]);
  }
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t i = 0; i < items_.size(); ++i) visit(Id<T>{static_cast<int>(i)}, items_[i]);
  }

  /// Visits `count` objects, the number saved, by visit(id, object).  Restoring replaces all.
  template <typename Visit>
  void visit_items(StateArchive& archive, std::uint64_t count, const Visit& visit) {
    if (archive.restoring()) items_.clear();
    // The list grows while reading, so that a wrong count allocates no memory.
    for (std::uint64_t i = 0; i < count; ++i) {
      if (archive.restoring()) items_.emplace_back();
      visit(Id<T>{static_cast<int>(i)}, items_[i]);
    }
  }
  void visit_free(StateArchive& archive) { archive.unhashed(free_); }
  /// Returns which objects are in use, by number.  Fails when a restored number is free twice or does not exist.
  std::vector<char> used(const StateArchive& archive) const {
    std::vector<char> used(items_.size(), 1);
    for (const int number : free_) {
      if (!contains(number)) archive.fail("a signal that does not exist");
      if (!std::exchange(used[static_cast<std::size_t>(number)], 0)) archive.fail("a signal that is freed twice");
    }
    return used;
  }

 private:
  List items_;
  std::vector<int> free_;
};

}  // namespace sim
