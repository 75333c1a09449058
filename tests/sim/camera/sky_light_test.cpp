// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/sky_light.hpp"

#include <gtest/gtest.h>

#include "sim/scene/light.hpp"

namespace {

sim::LightConfig noon() {
  sim::LightConfig light;
  light.sun_azimuth_rad = 0;
  light.sun_elevation_rad = sim::degrees_to_radians(60);
  light.zenith_color = "#0000ff";
  light.horizon_color = "#ffffff";
  return light;
}

TEST(SkyLight, HasItsColorsOverheadAndAtTheHorizon) {
  sim::LightConfig light = noon();
  light.sun = 0;  // its halo would add to both
  const sim::SkyLight sky(light);
  EXPECT_TRUE(sky.from({0, 0, 1}).isApprox(sim::LinearColor(0, 0, 1), 1e-6F));
  EXPECT_TRUE(sky.from({1, 0, 0}).isApprox(sim::LinearColor(1, 1, 1), 1e-6F));
  // The square root of the height: a quarter of the way up is half of the way to the color overhead.
  EXPECT_TRUE(sky.from({std::sqrt(1 - 0.0625F), 0, 0.25F}).isApprox(sim::LinearColor(0.5F, 0.5F, 1), 1e-5F));
}

TEST(SkyLight, BelowTheHorizonItIsTheGroundWhateverTheSky) {
  sim::LightConfig light = noon();
  light.sun = 0;
  const sim::LinearColor below = sim::SkyLight(light).from({0, 0, -1});
  light.zenith_color = light.horizon_color = "#123456";
  EXPECT_TRUE(sim::SkyLight(light).from({0, 0, -1}).isApprox(below, 1e-5F));
}

TEST(SkyLight, TheSunIsADiscWithAHalo) {
  const sim::SkyLight sky(noon());
  ASSERT_TRUE(sky.sun_is_up());
  const Eigen::Vector3f to_sun = sky.to_sun_W();
  EXPECT_TRUE(sky.from(to_sun).isApprox(sky.sun() * 1.5F));
  const Eigen::Vector3f beside = Eigen::AngleAxisf(0.05F, Eigen::Vector3f::UnitX()) * to_sun;
  const Eigen::Vector3f away(-to_sun.x(), -to_sun.y(), to_sun.z());
  EXPECT_GT(sky.from(beside).x(), sky.from(away).x());
}

TEST(SkyLight, WithoutTheSunThereIsNoDisc) {
  sim::LightConfig light = noon();
  light.sun_elevation_rad = sim::degrees_to_radians(-5);
  const sim::SkyLight night(light);
  EXPECT_FALSE(night.sun_is_up());
  EXPECT_FALSE(night.from(night.to_sun_W()).isApprox(night.sun() * 1.5F));
}

}  // namespace
