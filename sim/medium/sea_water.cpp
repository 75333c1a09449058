// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/sea_water.hpp"

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

}  // namespace sim
