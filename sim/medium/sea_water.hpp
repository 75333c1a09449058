// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace sim {

// Properties of sea water.  Temperatures in degrees C (IPTS-68), salinities in practical salinity units.

/// Speed of sound, m/s, at a depth in m: Mackenzie, J. Acoust. Soc. Am. 70, 807 (1981).
double mackenzie_mps(double temperature_C, double salinity_psu, double depth_m);
/// Speed of sound, m/s, at a depth in m: Medwin, J. Acoust. Soc. Am. 58, 1318 (1975); to 1000 m.
double medwin_mps(double temperature_C, double salinity_psu, double depth_m);
/// Speed of sound, m/s, at a pressure relative to the atmosphere: Chen and Millero 1977, as in Fofonoff and Millard,
/// Unesco technical papers in marine science 44 (1983).
double chen_millero_mps(double temperature_C, double salinity_psu, double pressure_dbar);
/// Density, kg/m^3, at a pressure relative to the atmosphere: the International Equation of State 1980 (EOS-80), as in
/// the same paper.
double eos80_kgpm3(double temperature_C, double salinity_psu, double pressure_dbar);

}  // namespace sim
