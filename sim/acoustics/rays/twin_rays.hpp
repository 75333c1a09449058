// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/acoustics/rays/eigenrays.hpp"

namespace sim {

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
