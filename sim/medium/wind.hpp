// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "sim/medium/gauss_markov.hpp"
#include "sim/medium/medium_config.hpp"

namespace sim {

/// How the air moves: a mean by height, and gusts that are the same everywhere.
class Wind {
 public:
  Wind(const WindConfig& config, std::uint64_t seed);

  /// Not back in time.
  void advance_to(Time now);
  /// m/s in the world, at a height over the still water (over z = 0 in a world without).
  Vector3d velocity_W(double height_m) const;
  /// After restoring the gust follows at the next advance_to().
  void visit_state(StateArchive& archive) {
    if (gusts_) archive(*gusts_);
  }

 private:
  WindConfig config_;
  Vector3d mean_W_, gust_W_ = Vector3d::Zero();
  std::optional<GaussMarkov> gusts_;
};

}  // namespace sim
