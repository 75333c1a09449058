// SPDX-License-Identifier: BSD-3-Clause
#include "sim/scene/light.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/config/read_yaml.hpp"

namespace {

sim::LightConfig light_of(const std::string& yaml) {
  sim::LightConfig light;
  EXPECT_THAT(test::errors_of_reading(yaml, [&](sim::ParamReader& in) { light.read(in); }), testing::IsEmpty());
  return light;
}

TEST(Light, TheSunIsInTheDirectionOfACompass) {
  const double half = std::sqrt(0.5);
  // In the east, then half-way up in the south.
  EXPECT_TRUE(
      light_of("{sun_azimuth_deg: 90, sun_elevation_deg: 0}").to_sun_W().isApprox(sim::Vector3d(1, 0, 0), 1e-12));
  EXPECT_TRUE(light_of("{sun_azimuth_deg: 180, sun_elevation_deg: 45}")
                  .to_sun_W()
                  .isApprox(sim::Vector3d(0, -half, half), 1e-12));
  EXPECT_LT(light_of("{sun_elevation_deg: -10}").to_sun_W().z(), 0);
}

TEST(Light, SaysWhatIsWrongWithAColor) {
  sim::LightConfig light;
  EXPECT_THAT(test::errors_of_reading("{zenith_color: blue, horizon_color: '#12345'}",
                                      [&](sim::ParamReader& in) { light.read(in); }),
              testing::ElementsAre("w.yaml:1:16: 'zenith_color' must look like #rrggbb, got 'blue'",
                                   "w.yaml:1:37: 'horizon_color' must look like #rrggbb, got '#12345'"));
}

TEST(Color, HasTwoHexadecimalDigitsForEachPart) {
  EXPECT_EQ(sim::parse_color("#0a80ff"), (sim::Color{10, 128, 255}));
  EXPECT_EQ(sim::parse_color("#FFffFf"), (sim::Color{255, 255, 255}));
}

TEST(Color, OtherTextsAreNone) {
  for (const char* text : {"", "#", "0a80ff", "#0a80f", "#0a80ff0", "#0a80fg", "#+a80ff", "# a80ff", "#-180ff", "red"})
    EXPECT_FALSE(sim::parse_color(text)) << text;
}

}  // namespace
