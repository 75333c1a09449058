// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/acoustics/multipath.hpp"

namespace sim {

/// Where the ends of a link are in water of one depth.
struct LinkDepths {
  double source_m = 0, receiver_m = 0;  ///< below the surface
  double horizontal_m = 0;
  double water_m = 0;  ///< infinite: no bottom
};

/// What the echoes make of the direct path: powers over that of the direct path.
struct Echoes {
  PowerRatio signal{1};  ///< all inside the window, the direct path with them
  PowerRatio late{0};    ///< what comes later and disturbs
  double spread_s = 0;   ///< rms of the delays
  double later_s = 0;    ///< delay of the first arrival relative to the direct path, where that is blocked
};

/// Depths out of the water count as at surface and bottom.  `random`: draws the phases for `phases: random`; null:
/// powers add up, which is their mean over all phases.  `direct`: what an obstacle leaves of the direct path, minus
/// infinity when nothing; the powers are over what it would be without.
Echoes echoes(const MultipathConfig& config, const MultipathMedium& medium, const LinkDepths& depths, Random* random,
              Decibels direct = Decibels(0));

}  // namespace sim
