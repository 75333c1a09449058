// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace sim {

// The practical salinity scale 1978 (N. P. Fofonoff and R. C. Millard, Algorithms for computation of fundamental
// properties of seawater, UNESCO technical papers in marine science 44, 1983).  Temperatures are in degrees C,
// pressures in dbar over that of the air, conductivities in S/m.  Good for 2 to 42 psu and -2 to 35 C; beyond that the
// answers are finite.

/// Conductivity of sea water of 35 psu at 15 C and 0 dbar, S/m.
constexpr double standard_conductivity_Spm = 4.2914;

/// 0 for a conductivity of 0 or less.
double practical_salinity_psu(double conductivity_Spm, double temperature_C, double pressure_dbar);

/// The conductivity that has this salinity, by Newton's method; 0 for a salinity of 0 or less.
double conductivity_Spm(double salinity_psu, double temperature_C, double pressure_dbar);

}  // namespace sim
