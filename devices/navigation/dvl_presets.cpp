// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/dvl_presets.hpp"

namespace devices {

// Data sheets give the standard deviation of one ping for the horizontal velocity; along a beam it is sqrt(2) sin(beam
// angle) times that.  The long-term accuracy, such as 0.2 % +- 1 mm/s, is taken as one standard deviation of scale
// and bias.  Figures are not verified against the data sheets unless marked as checked.
const DvlPreset presets[] = {
    // Teledyne RD Instruments, Workhorse Navigator: 600 kHz; 30 deg and four beams checked (its FAQ).  0.2 % +- 1 mm/s,
    // 3 mm/s at 1 m/s and 4 mm/s at 3 m/s, 0.7 to 90 m, 7 Hz.
    {"workhorse_600", 30, 0.7, 90, 1.77e-3, 3.54e-4, 0.002, 0.001, 7},
    // The same at 300 kHz: 0.4 % +- 2 mm/s, to 200 m.  The noise of a ping is taken as twice that at 600 kHz.
    {"workhorse_300", 30, 1, 200, 3.54e-3, 7.07e-4, 0.004, 0.002, 7},
    // The same at 1200 kHz: 0.2 % +- 1 mm/s, to 30 m.
    {"workhorse_1200", 30, 0.5, 30, 1.77e-3, 3.54e-4, 0.002, 0.001, 7},
    // Nortek DVL1000: 25 deg, 0.2 to 75 m (75 m checked: a training text of VideoRay), 0.1 to 0.3 % +- 1 mm/s, 8 Hz;
    // 2 mm/s per ping as in DUNE (LSTS).
    {"dvl1000", 25, 0.2, 75, 1.2e-3, 0, 0.002, 0.001, 8},
};

std::span<const DvlPreset> dvl_presets() {
  return presets;
}

}  // namespace devices
