// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/tdma.hpp"

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

}  // namespace autonomy
