// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/acoustics/propagation/decibels.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/medium/medium.hpp"

namespace sim {

/// Spreading loss relative to 1 m: k 10 log10(range), 0 closer than 1 m.  k: 1 cylindrical, 1.5 practical, 2 spherical
/// (Urick, Principles of Underwater Sound, 1983, chapter 5).
Decibels spreading_loss(double range_m, double k);
/// Spreading loss, spherical up to the transition range and cylindrical beyond.
Decibels spreading_loss_with_transition(double range_m, double transition_range_m);

/// Loss by absorption over a range.
Decibels absorption_loss(double range_m, double absorption_dBpkm);

/// `spreading:` of a world's acoustics.
struct SpreadingConfig {
  double factor = 1.5;                       ///< k of k 10 log10(range)
  std::optional<double> transition_range_m;  ///< instead of the factor
  void read(ParamReader& in);
};

/// Spreading loss by a configuration.
Decibels spreading_loss(double range_m, const SpreadingConfig& config);

/// `absorption:` of a world's acoustics.
struct AbsorptionConfig {
  enum class Model { thorp, francois_garrison, constant };

  Model model = Model::francois_garrison;
  double dBpkm = 0;  ///< constant
  double pH = 8;     ///< francois_garrison
  void read(ParamReader& in);
};

/// Mean absorption along the straight line between two points, dB/km.  For Francois and Garrison, temperature and
/// salinity are taken at both ends and in the middle (Simpson's rule).
double absorption_dBpkm(const AbsorptionConfig& config, double frequency_Hz, const Medium& medium,
                        const Vector3d& from_W, const Vector3d& to_W);

}  // namespace sim
