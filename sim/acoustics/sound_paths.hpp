// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/acoustics/acoustics_config.hpp"

namespace sim {

/// Returns how sound travels in water with or without a profile of its speed.
inline SoundPaths sound_paths(const AcousticsConfig& acoustics, bool has_profile) {
  return acoustics.propagation.value_or(has_profile ? SoundPaths::rays : SoundPaths::straight);
}

/// Returns the spreading of sound along straight lines: spherical where the other sound travels along rays, whose tubes
/// are the spreading.
inline SpreadingConfig straight_spreading(const AcousticsConfig& acoustics, bool has_profile) {
  SpreadingConfig spherical;
  spherical.factor = 2;
  return sound_paths(acoustics, has_profile) == SoundPaths::rays ? spherical : acoustics.spreading;
}

}  // namespace sim
