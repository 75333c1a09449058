// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/acoustics/propagation/acoustics_config.hpp"
#include "sim/acoustics/rays/ray_trace.hpp"
#include "sim/medium/medium.hpp"

namespace verification {

/// Sound of one source in the vertical plane.
struct RayField {
  struct Point {
    double range_m, depth_m;
    double loss_dB;  ///< of all rays together, with absorption; infinite: none arrives
    bool shadow;     ///< no ray without a bounce arrives
  };
  std::vector<sim::SoundProfile::Knot> profile;  ///< down to `deepest_m`
  std::vector<sim::RayTrace> fan;                ///< traced until the first bottom bounce, or further with `multipath:`
  double fan_step_m = 0;                         ///< range between two depths of a trace
  std::vector<Point> points;                     ///< column by column, `rows` in each
  int columns = 0, rows = 0;
  double source_m = 0, range_m = 0, deepest_m = 0;
};

/// Computes rays and losses from a source at a depth to all depths and ranges up to `range_m`.  `water_depth_m`: as for
/// link_budget().
RayField ray_field(double source_m, double range_m, double frequency_Hz, const sim::AcousticsConfig& acoustics,
                   const sim::Medium& medium, std::optional<double> water_depth_m);

/// Draws the speed of sound, and the losses with the fan of rays over them; shadows are hatched.  Throws
/// std::runtime_error when gnuplot fails.
void draw_rays(const RayField& field, const std::string& title, const std::string& png);

}  // namespace verification
