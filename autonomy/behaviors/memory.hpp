// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>

namespace autonomy {

/// Copies of a program's state, one after each of its decisions, so that it can be rewound with the world.
class Memory {
 public:
  /// Maximum number of copies.
  static constexpr std::size_t max_copies = 100'000;

  /// `state` is the state of the program: a value that holds everything its decisions depend on.  It must outlive this.
  /// Copies are kept for `seconds` of simulated time; 0: none.
  template <class State>
  Memory(State& state, double seconds)
      : keep_us_(static_cast<std::int64_t>(seconds * 1e6)),
        copy_([&state] { return std::make_shared<const State>(state); }),
        restore_saved_([&state](const void* kept) { state = *static_cast<const State*>(kept); }) {
    if (keep_us_ > 0) copies_.push_back({std::numeric_limits<std::int64_t>::min(), copy_()});
  }

  /// Call after the decision of the tick `utime`, which is later than the last one.
  void keep(std::int64_t utime);
  /// Restores the state after a rewind of the world, where the tick `utime` is the first one: the state after the last
  /// decision before it.  Returns false, with the state unchanged, when there is no such copy.
  bool rewind(std::int64_t utime);
  std::size_t size() const { return copies_.size(); }

 private:
  struct Saved {
    std::int64_t utime;  ///< the smallest number: before the first decision
    std::shared_ptr<const void> state;
  };

  std::int64_t keep_us_;
  std::function<std::shared_ptr<const void>()> copy_;
  std::function<void(const void*)> restore_saved_;
  std::deque<Saved> copies_;
};

}  // namespace autonomy
