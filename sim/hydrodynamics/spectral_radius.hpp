// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/model/hydrodynamics_config.hpp"

namespace sim {

/// Largest magnitude of the eigenvalues of a matrix, which need not be symmetric.  In a separate file: Eigen's solver
/// takes longer to compile than the rest of the model.
double spectral_radius(const Matrix6d& matrix);

}  // namespace sim
