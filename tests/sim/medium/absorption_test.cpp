// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/absorption.hpp"

#include <gtest/gtest.h>

#include "tests/fidelity/closed_forms.hpp"

namespace {

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

}  // namespace
