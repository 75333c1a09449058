// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

#include "autonomy/behaviors/scan.hpp"
#include "autonomy/filters/pose2.hpp"
#include "sim/random/random.hpp"

namespace autonomy {

/// Wandering behavior without a goal: drives ahead, and turns left for a random time when an obstacle is near.  Used
/// by the rovers of `shoal bench`; one step for each scan.
class Wander {
 public:
  static constexpr double forward_mps = 0.4;
  static constexpr double turning_forward_mps = 0.05;
  static constexpr double turn_radps = 0.5;
  static constexpr double turn_below_m = 1.0;  ///< of the middle third of the scan
  static constexpr double stop_below_m = 0.3;  ///< of the whole scan
  static constexpr int shortest_turn = 10;     ///< steps
  static constexpr int max_turn = 19;

  /// `name`: of the vehicle; each has its own random stream.
  Wander(std::uint64_t seed, std::string_view name) : random_(seed, name) {}

  Twist step(const Scan& scan);

 private:
  sim::Random random_;
  std::int64_t steps_ = 0;
  int turn_left_ = 0;  ///< remaining steps of the turn
};

}  // namespace autonomy
