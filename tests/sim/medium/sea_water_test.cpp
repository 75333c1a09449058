// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/sea_water.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "sim/medium/water_column.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/fidelity/closed_forms.hpp"

namespace {

using test::closed_forms_of;
using test::expect_closed_form;

TEST(SeaWater, SoundIsAsFastAsTheEquationsSay) {
  for (const auto& form : closed_forms_of("sound_speed_mackenzie"))
    expect_closed_form(sim::mackenzie_mps(form.at("T"), form.at("S"), form.at("depth")), form);
  for (const auto& form : closed_forms_of("sound_speed_medwin"))
    expect_closed_form(sim::medwin_mps(form.at("T"), form.at("S"), form.at("depth")), form);
  for (const auto& form : closed_forms_of("sound_speed_unesco_chen_millero"))
    expect_closed_form(sim::chen_millero_mps(form.at("T68"), form.at("S"), form.at("p_dbar")), form);
}

TEST(SeaWater, DensityHasTheCheckValuesOfUnesco) {
  // Unesco technical papers in marine science 36 (1981), check values of the equation, to their last digit.
  EXPECT_NEAR(sim::eos80_kgpm3(5, 0, 0), 999.96675, 5e-6);
  EXPECT_NEAR(sim::eos80_kgpm3(5, 35, 0), 1027.67547, 5e-6);
  EXPECT_NEAR(sim::eos80_kgpm3(5, 0, 10000), 1044.12802, 5e-6);
  EXPECT_NEAR(sim::eos80_kgpm3(25, 35, 10000), 1062.53817, 5e-6);
}

TEST(Absorption, ThorpHasTheValuesOfTheReference) {
  for (const auto& form : test::closed_forms_of("absorption_thorp"))
    test::expect_closed_form(sim::thorp_dBpkm(form.at("f_kHz")), form);
}

TEST(Absorption, FrancoisAndGarrisonIsNearThorpInColdSeaWater) {
  // Both are fits to measurements: within a fifth of each other at the surface.
  const sim::SeaWater cold{4, 35, 0, 8};
  for (const double frequency_kHz : {5.0, 10.0, 25.0, 50.0})
    EXPECT_NEAR(sim::francois_garrison_dBpkm(frequency_kHz, cold) / sim::thorp_dBpkm(frequency_kHz), 1, 0.2)
        << frequency_kHz;
}

TEST(Absorption, FreshWaterAbsorbsAsPureWaterDoes) {
  // The third term alone: 4.937e-4 - 2.59e-4 + 0.911e-4 - 0.15e-4 dB/km/kHz^2 at 10 C.
  EXPECT_NEAR(sim::francois_garrison_dBpkm(100, {10, 0, 0, 8}), 3.108e-4 * 1e4, 1e-9);
  EXPECT_NEAR(sim::francois_garrison_dBpkm(100, {10, 0, 1000, 8}), 3.108 * (1 - 3.83e-2 + 4.9e-4), 1e-9);
}

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
