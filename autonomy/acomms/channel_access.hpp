// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "autonomy/acomms/random_access.hpp"
#include "autonomy/acomms/tdma.hpp"

namespace autonomy {

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
