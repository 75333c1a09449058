// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

namespace devices {

/// Parameters of a Doppler velocity log from its data sheet.
struct DvlPreset {
  std::string name;
  double beam_angle_deg;
  double altitude_min_m, altitude_max_m;
  double beam_std_mps, beam_std_per_mps;  ///< noise of one ping along a beam: first + second * speed
  double scale_std;                       ///< relative error of all velocities
  double bias_std_mps;                    ///< bias of each axis
  double rate_hz;                         ///< for documentation; a preset cannot set the common key `rate_hz`
};

/// Returns all presets.
std::span<const DvlPreset> dvl_presets();

}  // namespace devices
