// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/channel_access.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace autonomy {

Tdma::Tdma(const Params& params) : params_(params), slot_us_(0), guard_us_(0) {
  if (params.slots < 1 || params.slot < 0 || params.slot >= params.slots)
    throw std::invalid_argument("a slot is I/N with 0 <= I < N, got " + std::to_string(params.slot) + "/" +
                                std::to_string(params.slots));
  if (!(params.slot_s >= 0.001) || !(params.slot_s < 1e6) || !(params.guard_s >= 0) ||
      !(params.guard_s < params.slot_s))
    throw std::invalid_argument("a slot must be 0.001 to 1e6 s, and its guard time shorter than it");
  slot_us_ = std::llround(params.slot_s * 1e6);
  guard_us_ = std::llround(params.guard_s * 1e6);
}

bool Tdma::take_turn(std::int64_t utime) {
  const std::int64_t cycle_us = slot_us_ * params_.slots;
  const std::int64_t since_us = utime - slot_us_ * params_.slot;
  const std::int64_t turn = since_us >= 0 ? since_us / cycle_us : -((-since_us + cycle_us - 1) / cycle_us);
  if (since_us - turn * cycle_us >= slot_us_ - guard_us_) return false;
  // A clock that is set back a little causes no second turn in the same slot; one set back by more restarts.
  if (last_turn_ && (turn == *last_turn_ || turn == *last_turn_ - 1)) return false;
  last_turn_ = turn;
  return true;
}

double default_guard_s(double slot_s) {
  return std::max(0.5 * slot_s, slot_s - 1);
}

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
