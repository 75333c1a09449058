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

/// Properties of sea water that determine the absorption of sound.
struct SeaWater {
  double temperature_C = 10;
  double salinity_psu = 35;
  double depth_m = 0;
  double pH = 8;
};

/// Absorption of sound in the sea by W. H. Thorp's formula, dB/km: at 4 C and 1 km depth, 0.1 to 50 kHz (Deep-sea sound
/// attenuation in the sub- and low-kilocycle-per-second region, JASA 38, 1965, in the metric form of Urick).
double thorp_dBpkm(double frequency_kHz);

/// Absorption of sound in sea water, dB/km, 0.4 to 1000 kHz: boric acid, magnesium sulphate and pure water (R. E.
/// Francois and G. R. Garrison, Sound absorption based on ocean measurements, JASA 72, 1982, part II).
double francois_garrison_dBpkm(double frequency_kHz, const SeaWater& water);

// Practical Salinity Scale 1978 (N. P. Fofonoff and R. C. Millard, Algorithms for computation of fundamental properties
// of seawater, UNESCO technical papers in marine science 44, 1983).  Temperatures in degrees C, pressures in dbar
// relative to the atmosphere, conductivities in S/m.  Valid for 2 to 42 psu and -2 to 35 C; results are finite beyond
// that range.

/// Conductivity of sea water of 35 psu at 15 C and 0 dbar, S/m.
constexpr double standard_conductivity_Spm = 4.2914;

/// Salinity from conductivity; 0 for a conductivity of 0 or less.
double practical_salinity_psu(double conductivity_Spm, double temperature_C, double pressure_dbar);

/// Conductivity at this salinity, by Newton's method; 0 for a salinity of 0 or less.
double conductivity_Spm(double salinity_psu, double temperature_C, double pressure_dbar);

}  // namespace sim
