// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/model/hydrodynamics_config.hpp"

namespace sim {

/// Returns the diagonal of the added mass of a prolate spheroid about its center, long axis along x: kg, kg, kg, kg
/// m^2, kg m^2, kg m^2.  It is an approximation for slender hulls without published coefficients.  `half_length_m` must
/// be at least `radius_m`.  Potential flow about an ellipsoid: Lamb, Hydrodynamics, articles 114 and 115.
Vector6d spheroid_added_mass(double half_length_m, double radius_m, double density_kgpm3);

}  // namespace sim
