// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/sea_water.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

double mackenzie_mps(double T, double S, double D) {
  return 1448.96 + 4.591 * T - 5.304e-2 * T * T + 2.374e-4 * T * T * T + 1.340 * (S - 35) + 1.630e-2 * D +
         1.675e-7 * D * D - 1.025e-2 * T * (S - 35) - 7.139e-13 * T * D * D * D;
}

double medwin_mps(double T, double S, double D) {
  return 1449.2 + 4.6 * T - 0.055 * T * T + 0.00029 * T * T * T + (1.34 - 0.010 * T) * (S - 35) + 0.016 * D;
}

double chen_millero_mps(double T, double S, double pressure_dbar) {
  const double P = pressure_dbar / 10;  // bar
  const double C0 = 1402.388 + T * (5.03711 + T * (-5.80852e-2 + T * (3.3420e-4 + T * (-1.47800e-6 + T * 3.1464e-9))));
  const double C1 = 0.153563 + T * (6.8982e-4 + T * (-8.1788e-6 + T * (1.3621e-7 + T * -6.1185e-10)));
  const double C2 = 3.1260e-5 + T * (-1.7107e-6 + T * (2.5974e-8 + T * (-2.5335e-10 + T * 1.0405e-12)));
  const double C3 = -9.7729e-9 + T * (3.8504e-10 + T * -2.3643e-12);
  const double A0 = 1.389 + T * (-1.262e-2 + T * (7.164e-5 + T * (2.006e-6 + T * -3.21e-8)));
  const double A1 = 9.4742e-5 + T * (-1.2580e-5 + T * (-6.4885e-8 + T * (1.0507e-8 + T * -2.0122e-10)));
  const double A2 = -3.9064e-7 + T * (9.1041e-9 + T * (-1.6002e-10 + T * 7.988e-12));
  const double A3 = 1.100e-10 + T * (6.649e-12 + T * -3.389e-13);
  const double B = -1.922e-2 - 4.42e-5 * T + (7.3637e-5 + 1.7945e-7 * T) * P;
  const double D = 1.727e-3 - 7.9836e-6 * P;
  const double pure = C0 + P * (C1 + P * (C2 + P * C3));
  const double A = A0 + P * (A1 + P * (A2 + P * A3));
  return pure + S * (A + B * std::sqrt(S) + D * S);
}

double eos80_kgpm3(double T, double S, double pressure_dbar) {
  const double p = pressure_dbar / 10;  // bar
  const double root = std::sqrt(S);
  const double pure =
      999.842594 + T * (6.793952e-2 + T * (-9.095290e-3 + T * (1.001685e-4 + T * (-1.120083e-6 + T * 6.536332e-9))));
  const double A = 8.24493e-1 + T * (-4.0899e-3 + T * (7.6438e-5 + T * (-8.2467e-7 + T * 5.3875e-9)));
  const double B = -5.72466e-3 + T * (1.0227e-4 + T * -1.6546e-6);
  const double at_surface = pure + S * (A + B * root + 4.8314e-4 * S);
  const double K_pure = 19652.21 + T * (148.4206 + T * (-2.327105 + T * (1.360477e-2 + T * -5.155288e-5)));
  const double K0 = K_pure + S * (54.6746 + T * (-0.603459 + T * (1.09987e-2 + T * -6.1670e-5)) +
                                  root * (7.944e-2 + T * (1.6483e-2 + T * -5.3009e-4)));
  const double K1 = 3.239908 + T * (1.43713e-3 + T * (1.16092e-4 + T * -5.77905e-7)) +
                    S * (2.2838e-3 + T * (-1.0981e-5 + T * -1.6078e-6) + 1.91075e-4 * root);
  const double K2 =
      8.50935e-5 + T * (-6.12293e-6 + T * 5.2787e-8) + S * (-9.9348e-7 + T * (2.0816e-8 + T * 9.1697e-10));
  return at_surface / (1 - p / (K0 + p * (K1 + p * K2)));
}

namespace {

/// Relaxation term f_r f^2 / (f_r^2 + f^2) of a substance.
double relaxation(double f_kHz, double relaxation_kHz) {
  return relaxation_kHz * f_kHz * f_kHz / (relaxation_kHz * relaxation_kHz + f_kHz * f_kHz);
}

/// Terms of the substances that do not depend on the depth: they take powers, and most calls are for the same water.
struct Dissolved {
  double frequency_kHz = -1, temperature_C = 0, salinity_psu = 0, pH = 0;
  double boric_by_pH = 0, boric = 0, sulphate = 0;
  bool is_of(double f_kHz, const SeaWater& water) const {
    return f_kHz == frequency_kHz && water.temperature_C == temperature_C && water.salinity_psu == salinity_psu &&
           water.pH == pH;
  }
};

Dissolved dissolved(double f_kHz, const SeaWater& water) {
  Dissolved out{f_kHz, water.temperature_C, water.salinity_psu, water.pH};
  const double kelvin = 273 + water.temperature_C, S = water.salinity_psu;
  out.boric_by_pH = std::pow(10, 0.78 * water.pH - 5);
  out.boric = relaxation(f_kHz, 2.8 * std::sqrt(S / 35) * std::pow(10, 4 - 1245 / kelvin));
  out.sulphate = relaxation(f_kHz, 8.17 * std::pow(10, 8 - 1990 / kelvin) / (1 + 0.0018 * (S - 35)));
  return out;
}

}  // namespace

double thorp_dBpkm(double frequency_kHz) {
  const double f2 = frequency_kHz * frequency_kHz;
  return 0.11 * f2 / (1 + f2) + 44 * f2 / (4100 + f2) + 2.75e-4 * f2 + 0.003;
}

// Francois and Garrison, J. Acoust. Soc. Am. 72 (1982), part II: boric acid, magnesium sulphate and pure water.
double francois_garrison_dBpkm(double frequency_kHz, const SeaWater& water) {
  const double T = water.temperature_C, S = std::max(water.salinity_psu, 0.0), D = std::max(water.depth_m, 0.0);
  const double c_mps = 1412 + 3.21 * T + 1.19 * S + 0.0167 * D;
  double absorption = 0;
  if (S > 0) {
    thread_local Dissolved last;
    if (!last.is_of(frequency_kHz, water)) last = dissolved(frequency_kHz, water);
    absorption += 8.86 / c_mps * last.boric_by_pH * last.boric;
    absorption += 21.44 * S / c_mps * (1 + 0.025 * T) * (1 - 1.37e-4 * D + 6.2e-9 * D * D) * last.sulphate;
  }
  const double pure_water = T <= 20 ? 4.937e-4 + T * (-2.59e-5 + T * (9.11e-7 - 1.50e-8 * T))
                                    : 3.964e-4 + T * (-1.146e-5 + T * (1.45e-7 - 6.5e-10 * T));
  return absorption + pure_water * (1 - 3.83e-5 * D + 4.9e-10 * D * D) * frequency_kHz * frequency_kHz;
}

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
