// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/hydrodynamics/coefficient_model.hpp"

namespace sim {

/// Horizontal motion of a submerged craft, for checks of its file: ahead, tilted by pitch, or to the left, tilted by
/// roll.
enum class LevelMotion { ahead, sideways };

/// Returns the drag of the level craft against its motion, N.
double level_drag_N(const CoefficientModel& model, LevelMotion motion, double speed_mps);
/// Returns the torque that rights the craft in level motion at constant depth, N m per rad of tilt: that of weight and
/// buoyancy, less the Munk moment of its added mass (Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control,
/// 2021, section 6.3), and with all else that acts on the hull.  Below zero: it turns over.
double righting_Nmprad(const CoefficientModel& model, LevelMotion motion, double speed_mps);
/// Returns the speed above which the craft turns over although `held_Nmprad` rights it; infinity: above 20 m/s.
double tipping_mps(const CoefficientModel& model, LevelMotion motion, double held_Nmprad = 0);

/// Returns the x in [low, high] at which a falling condition ends to hold: `low` when it never does, `high` when
/// always.
template <typename Holds>
double last_where(double low, double high, const Holds& holds) {
  if (!holds(low)) return low;
  if (holds(high)) return high;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace sim
