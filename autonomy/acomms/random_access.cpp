// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/random_access.hpp"

#include <cmath>
#include <stdexcept>

namespace autonomy {

RandomAccess::RandomAccess(double mean_s, double jitter, std::uint64_t seed, std::string_view name)
    : mean_s_(mean_s), jitter_(jitter), random_(seed, name) {
  if (!(mean_s > 0) || !(mean_s < 1e9) || !(jitter >= 0) || !(jitter <= 1))
    throw std::invalid_argument("random access takes a mean interval > 0 s and a jitter of 0 to 1");
}

bool RandomAccess::take_turn(std::int64_t utime) {
  // Further ahead than the longest interval: the clock was set back.
  const std::int64_t max_us = std::llround(1e6 * mean_s_ * (1 + jitter_));
  if (next_utime_ && *next_utime_ - utime > max_us) next_utime_.reset();
  if (next_utime_ && utime < *next_utime_) return false;
  random_.begin_step(turns_++);
  const double interval_s = mean_s_ * (next_utime_ ? 1 + jitter_ * (2 * random_.uniform() - 1) : random_.uniform());
  const bool now = next_utime_.has_value();
  next_utime_ = utime + std::llround(1e6 * interval_s);
  return now;
}

}  // namespace autonomy
