// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/acoustics/propagation/decibels.hpp"
#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// `directivity:` of a transducer, in its frame S.
struct DirectivityConfig {
  enum class Pattern { omni, piston, hemisphere, toroid };

  Pattern pattern = Pattern::omni;
  double diameter_m = 0.1;  ///< piston: its axis is +x
  double length_m = 0.1;    ///< toroid: a line along z
  double floor_dB = -30;    ///< minimum response, relative to the axis
  void read(ParamReader& in);
};

/// Response relative to that on the axis (0 dB), for which source levels are given.  `direction_S`: from the
/// transducer, of any length; 0 dB for a length of 0.  omni: equal in all directions.  hemisphere: the half space about
/// +x.  piston: circular piston in a large baffle, 2 J1(ka sin a) / (ka sin a), no response behind.  toroid: line
/// source along z, sin(u) / u with u = (kL/2) sin of the elevation.  (Kinsler, Frey, Coppens, Sanders, Fundamentals of
/// Acoustics, 4th ed., 2000, chapter 7.)
Decibels directivity_gain(const DirectivityConfig& config, const Vector3d& direction_S, double frequency_Hz,
                          double sound_speed_mps);

/// Directivity index: reduction of isotropic noise relative to an omnidirectional transducer, integrated over the
/// pattern with its floor.
Decibels directivity_index(const DirectivityConfig& config, double frequency_Hz, double sound_speed_mps);

}  // namespace sim
