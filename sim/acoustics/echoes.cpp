// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/echoes.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

Echoes echoes(const MultipathConfig& config, const MultipathMedium& medium, const LinkDepths& depths, Random* random,
              Decibels direct_left) {
  const double water_m = std::max(0.0, depths.water_m);
  std::vector<ImagePath> paths;
  image_paths(std::clamp(depths.source_m, 0.0, water_m), std::clamp(depths.receiver_m, 0.0, water_m),
              depths.horizontal_m, water_m, config.max_bounces, paths);
  std::vector<PathGain> gains;
  path_gains(paths, config, medium, gains);
  // Relative to the direct path from here on, which also works at ranges where its power is below the smallest number.
  const Decibels direct = gains[0].gain;
  for (PathGain& gain : gains) gain.gain -= direct;
  const double direct_s = gains[0].delay_s;
  gains[0].gain += direct_left;
  if (std::isinf(direct_left.dB())) gains.erase(gains.begin());
  Echoes result;
  const bool drawn = config.phases == MultipathConfig::Phases::random;
  if (drawn && random != nullptr) randomize_phases(gains, *random);
  const MultipathSum sum = combine(gains, config.window_s);
  result.signal = sum.signal;
  result.late = sum.interference;
  result.spread_s = sum.spread_s;
  if (!gains.empty()) result.later_s = std::max(0.0, sum.first_s - direct_s);
  if (drawn && random == nullptr) {
    PowerRatio inside;
    for (const PathGain& gain : gains)
      if (gain.delay_s - sum.first_s <= config.window_s) inside += to_power(gain.gain);
    result.signal = inside;
  }
  return result;
}

}  // namespace sim
