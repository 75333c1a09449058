// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
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

/// Time division multiple access: `slots` senders take turns of `slot_s` each, by their own clocks.
class Tdma {
 public:
  struct Params {
    int slot = 0;   ///< own slot, from 0
    int slots = 1;  ///< in a cycle
    double slot_s = 10;
    /// No packet is started in the last seconds of a slot: transmission and propagation must end within it.
    double guard_s = 5;
  };

  /// Throws std::invalid_argument unless 0 <= slot < slots and 0 <= guard_s < slot_s.
  explicit Tdma(const Params& params);

  /// Returns whether to send now; true once for each turn.  A clock that is set back silences the sender for two cycles
  /// at most.
  bool take_turn(std::int64_t utime);

 private:
  Params params_;
  std::int64_t slot_us_;
  std::int64_t guard_us_;
  std::optional<std::int64_t> last_turn_;
};

/// Returns the guard time for an unknown packet length: turns start only in the first second of the slot, in a slot of
/// less than 2 s in its first half.  Time stamps at 1 Hz give a turn in each slot.
double default_guard_s(double slot_s);

/// Decides when a vehicle sends its state over the acoustic modem: in its slots, at random, or never.
class ChannelAccess {
 public:
  struct Params {
    std::optional<Tdma::Params> slot;
    double random_mean_s = 0;  ///< without a slot; 0: never
    double random_jitter = 0.5;
    std::uint64_t seed = 1;
  };

  ChannelAccess(const Params& params, const std::string& vehicle) {
    if (params.slot)
      tdma_.emplace(*params.slot);
    else if (params.random_mean_s > 0)
      random_.emplace(params.random_mean_s, params.random_jitter, params.seed, vehicle);
  }

  /// Returns whether to send now, by the vehicle's clock.
  bool take_turn(std::int64_t utime) {
    if (tdma_) return tdma_->take_turn(utime);
    return random_ && random_->take_turn(utime);
  }

 private:
  std::optional<Tdma> tdma_;
  std::optional<RandomAccess> random_;
};

}  // namespace autonomy
