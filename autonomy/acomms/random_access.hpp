// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "sim/random/random.hpp"

namespace autonomy {

/// Random access (ALOHA): sends at intervals that vary about a mean, so that two senders that collided once do not
/// collide repeatedly.
class RandomAccess {
 public:
  /// Intervals are uniform in `mean_s` (1 - jitter) to `mean_s` (1 + jitter).  Senders with different `name` differ
  /// with the same seed.  Throws std::invalid_argument unless mean_s > 0 and 0 <= jitter <= 1.
  RandomAccess(double mean_s, double jitter, std::uint64_t seed, std::string_view name);

  /// Returns whether to send now.  The first time is within one mean interval of the first call, and so is the next one
  /// after the clock was set back.
  bool take_turn(std::int64_t utime);

 private:
  double mean_s_;
  double jitter_;
  sim::Random random_;
  std::int64_t turns_ = 0;
  std::optional<std::int64_t> next_utime_;
};

}  // namespace autonomy
