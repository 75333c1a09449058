// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/practical_salinity.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Conductivity at this temperature relative to that at 15 C, at 35 psu and 0 dbar.
double temperature_ratio(double T) {
  return 0.6766097 + T * (2.00564e-2 + T * (1.104259e-4 + T * (-6.9698e-7 + T * 1.0031e-9)));
}

// Effect of pressure: ratio / (ratio at 0 dbar) = 1 + pressure_term / (pressure_b + pressure_a * ratio).
double pressure_term(double p) {
  return p * (2.070e-5 + p * (-6.370e-10 + p * 3.989e-15));
}
double pressure_a(double T) {
  return 4.215e-1 - 3.107e-3 * T;
}
double pressure_b(double T) {
  return 1 + T * (3.426e-2 + 4.464e-4 * T);
}

/// Salinity as a function of the square root x of the conductivity ratio at this temperature, and its derivative.
struct SalinityOfRoot {
  double salinity_psu, slope;
};
SalinityOfRoot salinity_of_root(double x, double T) {
  constexpr double a[] = {0.0080, -0.1692, 25.3851, 14.0941, -7.0261, 2.7081};
  constexpr double b[] = {0.0005, -0.0056, -0.0066, -0.0375, 0.0636, -0.0144};
  const double k = (T - 15) / (1 + 0.0162 * (T - 15));
  SalinityOfRoot result{0, 0};
  for (int i = 5; i >= 0; --i) {
    result.slope = result.slope * x + result.salinity_psu;
    result.salinity_psu = result.salinity_psu * x + a[i] + k * b[i];
  }
  return result;
}

/// Limits the temperature to a range without poles of the formulas, far beyond any water.
double usable_temperature(double temperature_C) {
  return std::clamp(temperature_C, -10.0, 60.0);
}

}  // namespace

double practical_salinity_psu(double conductivity_Spm, double temperature_C, double pressure_dbar) {
  if (!(conductivity_Spm > 0)) return 0;
  const double T = usable_temperature(temperature_C), p = std::max(pressure_dbar, 0.0);
  const double ratio = conductivity_Spm / standard_conductivity_Spm;
  const double pressure_ratio = 1 + pressure_term(p) / (pressure_b(T) + pressure_a(T) * ratio);
  const double root = std::sqrt(ratio / (pressure_ratio * temperature_ratio(T)));
  return std::max(salinity_of_root(root, T).salinity_psu, 0.0);
}

double conductivity_Spm(double salinity_psu, double temperature_C, double pressure_dbar) {
  if (!(salinity_psu > 0)) return 0;
  const double T = usable_temperature(temperature_C), p = std::max(pressure_dbar, 0.0);
  double root = std::sqrt(salinity_psu / 35);
  for (int i = 0; i < 10; ++i) {  // monotonic above 1 %: four steps converge
    const SalinityOfRoot at = salinity_of_root(root, T);
    root = std::max(root - (at.salinity_psu - salinity_psu) / at.slope, 0.01);
  }
  const double without_pressure = root * root * temperature_ratio(T);
  // Solve ratio = without_pressure (1 + term / (b + a ratio)), which is quadratic in the ratio.
  const double a = pressure_a(T), b = pressure_b(T) - a * without_pressure;
  const double c = without_pressure * (pressure_b(T) + pressure_term(p));
  return standard_conductivity_Spm * (-b + std::sqrt(b * b + 4 * a * c)) / (2 * a);
}

}  // namespace sim
