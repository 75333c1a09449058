// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/practical_salinity.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using sim::conductivity_Spm;
using sim::practical_salinity_psu;
using sim::standard_conductivity_Spm;

TEST(PracticalSalinity, HasTheCheckValuesOfTheUnescoPaper) {
  // UNESCO technical papers in marine science 44, check values of SAL78, printed with six decimals.
  EXPECT_NEAR(practical_salinity_psu(1.0 * standard_conductivity_Spm, 15, 0), 35.000000, 1e-6);
  EXPECT_NEAR(practical_salinity_psu(1.2 * standard_conductivity_Spm, 20, 2000), 37.245628, 1e-6);
  EXPECT_NEAR(practical_salinity_psu(0.65 * standard_conductivity_Spm, 5, 1500), 27.995347, 1e-6);
}

TEST(PracticalSalinity, ConductivityIsItsInverse) {
  for (const double salinity : {2.0, 10.0, 35.0, 42.0})
    for (const double temperature : {-2.0, 4.0, 15.0, 35.0})
      for (const double pressure : {0.0, 100.0, 6000.0})
        EXPECT_NEAR(practical_salinity_psu(conductivity_Spm(salinity, temperature, pressure), temperature, pressure),
                    salinity, 1e-9);
}

TEST(PracticalSalinity, IsFiniteForAnyWater) {
  for (const double salinity : {-1.0, 0.0, 1e-6, 0.1, 300.0})
    for (const double temperature : {-300.0, 0.0, 500.0}) {
      const double conductivity = conductivity_Spm(salinity, temperature, 1e5);
      EXPECT_TRUE(std::isfinite(conductivity)) << salinity << ' ' << temperature;
      EXPECT_TRUE(std::isfinite(practical_salinity_psu(conductivity, temperature, -10)));
    }
}

}  // namespace
