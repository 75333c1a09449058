// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/absorption.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

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

}  // namespace sim
