#include "sim/medium/absorption.hpp"

#include <gtest/gtest.h>

namespace {

TEST(Absorption, ThorpHasTheValuesOfTheReference) {
  // closed_forms.csv, absorption_thorp: 0.1 %.
  const double expected[][2] = {{1, 0.06900409047}, {5, 0.3823108974}, {10, 1.187029939}, {15, 2.463405615},
                                {25, 6.104805101},  {30, 8.280377913}, {50, 17.46712268}, {100, 34.06866276}};
  for (const auto& [frequency_kHz, dBpkm] : expected)
    EXPECT_NEAR(sim::thorp_dBpkm(frequency_kHz), dBpkm, 1e-3 * dBpkm) << frequency_kHz;
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
