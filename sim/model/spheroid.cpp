// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/spheroid.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace sim {

Vector6d spheroid_added_mass(double half_length_m, double radius_m, double density_kgpm3) {
  assert(half_length_m >= radius_m && radius_m > 0);
  const double a = half_length_m, b = radius_m;
  const double mass = 4.0 / 3 * std::numbers::pi * density_kgpm3 * a * b * b;
  const double e2 = 1 - (b / a) * (b / a), e = std::sqrt(e2);
  // Use the limit of a sphere for small eccentricity, where the formulas suffer from cancellation.
  if (e < 1e-2) return mass * (Vector6d() << 0.5, 0.5, 0.5, 0, 0, 0).finished();
  // Shape factors alpha_0 and beta_0 (Lamb, article 114).
  const double logarithm = std::log((1 + e) / (1 - e));
  const double alpha = 2 * (1 - e2) / (e2 * e) * (logarithm / 2 - e);
  const double beta = 1 / e2 - (1 - e2) / (2 * e2 * e) * logarithm;
  // Added mass over displaced mass, along and across the axis, and for rotation.
  const double along = alpha / (2 - alpha), across = beta / (2 - beta);
  const double turning = e2 * e2 * (beta - alpha) / ((2 - e2) * (2 * e2 - (2 - e2) * (beta - alpha)));
  const double inertia = mass * (a * a + b * b) / 5;
  Vector6d added;
  added << along * mass, across * mass, across * mass, 0, turning * inertia, turning * inertia;
  return added;
}

}  // namespace sim
