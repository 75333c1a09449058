// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "sim/medium/gauss_markov.hpp"
#include "sim/medium/medium_config.hpp"

namespace sim {

/// Wind: a mean that depends on height, and gusts that are uniform in space.
class Wind {
 public:
  Wind(const WindConfig& config, std::uint64_t seed);

  /// Advances to a time, which must not decrease.
  void advance_to(Time now);
  /// Velocity in the world, m/s, at a height above the still water (above z = 0 in a world without water).
  Vector3d velocity_W(double height_m) const;
  /// Visits the state; the gust is updated by the next advance_to().
  void visit_state(StateArchive& archive) {
    if (gusts_) archive(*gusts_);
  }

 private:
  WindConfig config_;
  Vector3d mean_W_, gust_W_ = Vector3d::Zero();
  std::optional<GaussMarkov> gusts_;
};

}  // namespace sim
