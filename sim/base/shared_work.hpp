// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace sim {

/// CPU time of some steps, from which follows what further threads gain at most (Amdahl's law; memory, which cores
/// share, is not in it).
struct SharedWork {
  double alone_s = 0;      ///< of the thread that steps, without what it shared with others
  double shared_s = 0;     ///< of all threads in what they shared
  double max_piece_s = 0;  ///< of the longest piece of each work that was shared, which no further thread makes shorter
  std::int64_t steps = 0;  ///< measured

  /// Returns the part of the work that threads share, 0 to 1.
  double shared_part() const;
  /// Returns the time that the steps take with a number of threads, at least.
  double time_s(int threads) const;
  /// Returns the number of threads from which on twice as many make the steps less than a tenth faster.
  int useful_threads() const;
  /// Returns a line such as `more than 4 threads would gain less than a tenth: they share 60 % of the work of a step`
  /// when twice as many threads as `threads` would gain less than a tenth; else an empty text, even when too few steps
  /// were measured.
  std::string advice(int threads) const;
};

/// Measures the calling thread, and what it shares by any ThreadPool, during the life of this object.
class SharedWorkClock {
 public:
  /// Adds the times to `work`, which must outlive this; null: measures nothing.
  explicit SharedWorkClock(SharedWork* work);
  ~SharedWorkClock();
  SharedWorkClock(const SharedWorkClock&) = delete;
  SharedWorkClock& operator=(const SharedWorkClock&) = delete;

 private:
  SharedWork* work_;
  double start_s_ = 0;
};

}  // namespace sim
