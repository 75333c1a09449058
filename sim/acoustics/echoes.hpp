// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/acoustics/multipath.hpp"

namespace sim {

/// Geometry of a link in water of constant depth.
struct LinkDepths {
  double source_m = 0, receiver_m = 0;  ///< below the surface
  double horizontal_m = 0;
  double water_m = 0;  ///< infinite: no bottom
};

/// Effect of the echoes: powers relative to that of the direct path.
struct Echoes {
  PowerRatio signal{1};  ///< sum inside the window, including the direct path
  PowerRatio late{0};    ///< interference: echoes after the window
  double spread_s = 0;   ///< rms of the delays
  double later_s = 0;    ///< delay of the first arrival relative to the direct path, where that is blocked
};

/// Computes the echoes of a link.  Depths are limited to those between surface and bottom.  `random`: draws the phases
/// for `phases: random`; null: powers add, which is their mean over all phases.  `direct`: gain of the direct path due
/// to an obstacle, minus infinity when it is blocked; powers are relative to the unobstructed direct path.
Echoes echoes(const MultipathConfig& config, const MultipathMedium& medium, const LinkDepths& depths, Random* random,
              Decibels direct = Decibels(0));

}  // namespace sim
