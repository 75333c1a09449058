// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/acoustics/rays/eigenrays.hpp"

namespace sim {

/// Change of the pressure of a ray by the wave nature of sound near a caustic.
struct CausticChange {
  double power = 1;      ///< factor of the power by the ray tube
  double later_rad = 0;  ///< added to the phase of the later one of the two rays, taken from that of the earlier one
};

/// Computes it for two rays that merge at a smooth caustic and arrive `apart_rad` of phase apart, without the quarter
/// period that the later one has lost there.
///
/// Uniform asymptotics (Ludwig, Comm. Pure Appl. Math. 19, 1966; Kravtsov and Orlov, Caustics, Catastrophes and Wave
/// Fields, 2nd ed., 1999): with z = apart_rad / 2 the sum of two pressures A is 2 sqrt(pi) A x^(1/4) Ai(-x), x =
/// (3 z / 2)^(2/3), so that of each ray is A sqrt(pi z / 2) H(z) exp(i pi / 6), H the Hankel function of order 1/3: far
/// from the caustic A exp(i (z - pi / 4)), at the caustic finite.
CausticChange caustic_change(double apart_rad);

/// Where a ray is in its family.
struct RayRoot {
  int family, cycles;
  double xi;
  double slope;           ///< dr/dxi, a mean where the layers are thin
  double power_by_slope;  ///< power by the ray tube times the size of dr/dxi
  double thin;            ///< width in xi of the thin layer in which it turns; 0: of another one
};

/// Merges rays that the borders of thin layers have made of one or two, where the reach has kinks.  Of each ray there
/// is the root of the same number.
void merge_false_rays(std::vector<SoundRay>& rays, std::vector<RayRoot>& roots);

/// Finds the twins among the rays, the closest in time first, and sets their level and caustics.
void pair_twins(std::vector<SoundRay>& rays, const std::vector<RayRoot>& roots);

}  // namespace sim
