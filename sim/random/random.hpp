// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

#include "sim/state/state_archive.hpp"

namespace sim {

/// Returns the 64-bit FNV-1a hash of a text; equal on every machine.
std::uint64_t hash_text(std::string_view text);

/// Counter-based random stream (Philox 4x32-10, Salmon et al., SC'11).  The key is (seed, name); the counter is (step,
/// number of the draw), so that the draws of a device at a step are independent of everything else in the world: a new
/// device does not change the noise of others, and the number of threads has no effect.
class Random {
 public:
  /// `name`: such as "auv1/lidar".
  Random(std::uint64_t seed, std::string_view name);

  /// Starts the draws of a step.  Call before the first draw of each step.
  void begin_step(std::int64_t step);
  /// Returns 64 random bits.
  std::uint64_t bits();
  /// Returns a uniform number in (0, 1), never 0 or 1.
  double uniform();
  /// Returns a standard normal number, by inversion of the normal distribution (Wichura 1988, algorithm AS 241,
  /// PPND16); the sequence of the standard library is not specified.
  double gaussian();
  /// Returns a uniform integer in [0, n).  n > 0.
  std::uint32_t integer_below(std::uint32_t n);

  /// Visits the position within a step.  Owners that call begin_step() before each draw need not visit it.
  void visit_state(StateArchive& archive) {
    archive(counter_, block_, used_);
    archive.require(used_, 0, 2, "a place in a block of random numbers");
  }

 private:
  void refill();

  std::uint32_t key_[2];
  std::uint32_t counter_[4];
  std::uint64_t block_[2];
  int used_ = 2;
};

/// The standard normal quantile for p in (0, 1); relative error about 1e-16 (AS 241).
double normal_quantile(double p);

}  // namespace sim
