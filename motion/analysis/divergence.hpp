// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/motion/motion.hpp"
#include "sim/world_file/world_config.hpp"

namespace motion {

/// Differences of the models of a comparison, one quantity at a time.
struct DivergenceOptions {
  double duration_s = 30;  ///< from the start of the motion, after its approach; it is repeated
  double row_s = 0.1;      ///< time between two rows
  double mass = 0.1;       ///< share by which the masses are higher and lower
  double effort = 0.2;     ///< fraction by which the maximum efforts of the servos are reduced
  double friction = 0.2;   ///< by which the friction of the contacts is higher and lower
  int threads = 0;         ///< 0: one for each processor
};

/// Course of a vehicle in a perturbed model, seen from its course in the model as it is.
struct DivergenceCurve {
  std::string model;               ///< such as "mass +10 %"
  std::vector<double> distance_m;  ///< between the origins of the vehicle at equal times, by row
  double fell_s = -1;              ///< time from the start of the motion at which it fell; < 0: it did not
};

/// How far apart equal commands bring a vehicle in models that differ a little.
struct Divergence {
  double row_s = 0;
  double fell_s = -1;                   ///< of the model as it is; < 0: it did not fall
  double least_static_margin_m = 0;     ///< of the model as it is; NaN: never three contacts
  std::vector<DivergenceCurve> curves;  ///< mass +, mass -, effort -, friction +, friction -

  /// Returns the number of rows.
  std::size_t rows() const { return curves.front().distance_m.size(); }
  /// Returns the largest and the median distance over the models at a row, m.
  double greatest_m(std::size_t row) const;
  double median_m(std::size_t row) const;
  /// Returns the largest distance over the models and all rows up to one, m.
  double greatest_until_m(std::size_t row) const;
};

/// Plays a motion, repeated, in the world and in perturbed ones.  A vehicle that falls plays it further.  Results do
/// not depend on the number of threads.
Divergence divergence_of(const sim::WorldConfig& world, const std::string& vehicle, const sim::JointMotion& motion,
                         const DivergenceOptions& options);

}  // namespace motion
