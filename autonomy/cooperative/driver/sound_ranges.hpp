// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sim/acoustics/rays/eigenrays.hpp"
#include "sim/medium/medium.hpp"

namespace navigation {

/// How navigation assumes sound to travel.
enum class SoundModel {
  straight,  ///< along straight lines, with the harmonic mean of the speed of sound between both depths
  rays,      ///< along rays that bend with the speed of sound over the depth
};

/// Converts travel times to ranges, by the profile of the speed of sound that navigation knows.
class SoundRanges {
 public:
  /// 1500 m/s everywhere.
  SoundRanges() : SoundRanges(1500) {}
  explicit SoundRanges(double speed_mps);
  /// Water without waves and tide; 1500 m/s in a world without water.
  explicit SoundRanges(const sim::Medium& medium);

  /// Returns the harmonic mean of the speed of sound between two depths, m/s.
  double mean_speed_mps(double depth_a_m, double depth_b_m) const;
  /// Returns the distance (m) of two points from the travel time between them, which is below 0 where a clock is that
  /// wrong.  With rays it is that of the first ray without a bounce; nothing where none takes this time, as for an echo
  /// in a shadow.
  std::optional<double> range_m(SoundModel model, double travel_time_s, double depth_a_m, double depth_b_m) const;

 private:
  std::optional<double> direct_time_s(double range_m, double depth_a_m, double depth_b_m) const;

  std::vector<double> speeds_mps_;  ///< at the middle of layers of layer_m, from the surface down
  std::shared_ptr<const sim::Eigenrays> rays_;
};

}  // namespace navigation
