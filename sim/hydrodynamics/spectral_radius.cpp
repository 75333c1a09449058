// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/spectral_radius.hpp"

#include <Eigen/Eigenvalues>

namespace sim {

double spectral_radius(const Matrix6d& matrix) {
  return matrix.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace sim
