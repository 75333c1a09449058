// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

namespace devices {

/// A Doppler velocity log by its data sheet.
struct DvlPreset {
  std::string name;
  double beam_angle_deg;
  double altitude_min_m, altitude_max_m;
  double beam_std_mps, beam_std_per_mps;  ///< of one ping along a beam: the first plus the second times the speed
  double scale_std;                       ///< of the factor of all velocities
  double bias_std_mps;                    ///< of each axis
  double rate_hz;                         ///< for the documents: a preset cannot set the common key `rate_hz`
};

std::span<const DvlPreset> dvl_presets();

}  // namespace devices
