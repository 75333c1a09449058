// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/acoustics/rays/eigenrays.hpp"
#include "sim/medium/medium_config.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Warns of rows of its `profile_file` that are skipped or unusual.
void warn_of_assumed_water(const std::optional<sim::WaterConfig>& water, const sim::DeviceContext& context);

/// Water as the user of a device knows it, through which the device follows the sound.
class AssumedWater {
 public:
  explicit AssumedWater(const sim::WaterConfig& config);
  const sim::SoundProfile& profile() const { return rays_.profile(); }
  /// Distance (m) of a point at a known depth whose first arrival takes this time, one way; depths below the surface.
  /// Where no ray arrives, as in a shadow, sound goes along the straight line.
  double distance_m(double own_depth_m, double depth_m, double time_s) const;

 private:
  double first_arrival_s(double own_depth_m, double depth_m, double across_m) const;

  sim::Eigenrays rays_;
};

}  // namespace devices
