// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/model/hydrodynamics_config.hpp"

namespace sim {

/// Added mass of a prolate spheroid about its centre, its long axis along x: kg, kg, kg, kg m^2, kg m^2, kg m^2.  A
/// good guess for a hull without published numbers.  `half_length_m` must be `radius_m` or more.  From the potential
/// flow about an ellipsoid (Lamb, Hydrodynamics, articles 114 and 115).
Vector6d spheroid_added_mass(double half_length_m, double radius_m, double density_kgpm3);

}  // namespace sim
