// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cross_check/exact.hpp"

#include <cmath>

namespace cross_check {

double pendulum_period_s(double omega_radps, double amplitude_rad) {
  return 4 * std::comp_ellint_1(std::sin(amplitude_rad / 2)) / omega_radps;
}

double tumbling_period_s(const sim::Vector3d& inertia_kgm2, const sim::Vector3d& w_radps) {
  double low = inertia_kgm2.x(), high = inertia_kgm2.z();
  const double middle = inertia_kgm2.y();
  const sim::Vector3d L = inertia_kgm2.cwiseProduct(w_radps);
  const double L2 = L.squaredNorm(), E2 = L.dot(w_radps);  // E2: twice the energy
  if (L2 < E2 * middle) std::swap(low, high);
  const double rate = std::sqrt((high - middle) * (L2 - E2 * low) / (low * middle * high));
  const double k2 = (middle - low) * (E2 * high - L2) / ((high - middle) * (L2 - E2 * low));
  return 4 * std::comp_ellint_1(std::sqrt(k2)) / rate;
}

double precession_radps(double across_kgm2, double along_kgm2, double spin_radps, double tilt_rad, double torque_Nm) {
  const double a = across_kgm2 * std::cos(tilt_rad), b = along_kgm2 * spin_radps;
  return 2 * torque_Nm / (b + std::sqrt(b * b - 4 * a * torque_Nm));
}

}  // namespace cross_check
