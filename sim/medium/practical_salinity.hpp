// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace sim {

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
