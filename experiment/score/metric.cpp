// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/metric.hpp"

#include <cmath>

namespace experiment {

double chi_square_95(int dimensions) {
  // Quantile tables of the chi-square distribution; with 2 degrees of freedom it is -2 ln 0.05.
  return dimensions == 2 ? -2 * std::log(0.05) : 7.814727903251179;
}

}  // namespace experiment
