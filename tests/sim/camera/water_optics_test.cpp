// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/water_optics.hpp"

#include <gtest/gtest.h>

namespace {

using sim::JerlovType;

TEST(WaterOptics, AttenuatesDaylightAsJerlovMeasured) {
  // Table XXVII of Jerlov (1976) at 650, 550 and 450 nm, 1/m.
  const std::pair<JerlovType, sim::LinearColor> rows[] = {{JerlovType::I, {0.36F, 0.063F, 0.019F}},
                                                          {JerlovType::II, {0.40F, 0.089F, 0.068F}},
                                                          {JerlovType::III, {0.445F, 0.12F, 0.135F}},
                                                          {JerlovType::C3, {0.46F, 0.19F, 0.39F}},
                                                          {JerlovType::C9, {0.76F, 0.63F, 1.6F}}};
  for (const auto& [type, downward] : rows) {
    const sim::WaterOptics water = sim::water_optics(type);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(water.downward[i], downward[i], 1e-5F);
      EXPECT_GT(water.absorption[i], 0);
      EXPECT_NEAR(water.attenuation[i], water.absorption[i] + water.scattering[i], 1e-6F);
      EXPECT_LE(water.molecular[i], water.scattering[i]);
    }
  }
  EXPECT_NEAR(sim::water_optics(JerlovType::II).scattering.y(), 0.365F, 1e-6F);
}

TEST(WaterOptics, WithoutChlorophyllIsPureWater) {
  const sim::WaterOptics pure = sim::chlorophyll_optics(0);
  EXPECT_NEAR(pure.absorption.y(), 0.0565F, 1e-6F);
  EXPECT_NEAR(pure.scattering.z(), 0.0045F, 1e-6F);
  // Chlorophyll makes blue water green.
  const sim::WaterOptics rich = sim::chlorophyll_optics(5);
  EXPECT_LT(pure.downward.z(), pure.downward.y());
  EXPECT_GT(rich.downward.z(), rich.downward.y());
  EXPECT_NEAR(rich.scattering.y(), 0.0019 + 0.3 * std::pow(5, 0.62), 1e-5);
}

}  // namespace
