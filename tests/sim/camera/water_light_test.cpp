// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/water_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "sim/bus/in_process_bus.hpp"
#include "sim/camera/renderer.hpp"
#include "sim/camera/water_view.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/sim/camera/water_view_fixture.hpp"

namespace {

using namespace water_view_fixture;

sim::FloatImage sea_image(const Sea& sea, const sim::Vector3d& eye_W, double visibility_m) {
  sim::WaterView water(sea.world.medium(), {}, {sim::water_optics(visibility_m > 0 ? visibility_m : 60)});
  water.update(eye_W);
  sim::RenderOptions options;
  options.water = visibility_m > 0 ? &water : nullptr;
  options.with_depth = true;
  sim::OpticsConfig optics;
  optics.width = 40, optics.height = 30;
  sim::Renderer renderer(sea.world.physics(), sim::make_pixel_rays(sim::Optics(optics), 1), options,
                         std::make_shared<sim::TextureLibrary>());
  sim::Pose X_WS = sim::Pose::Identity();
  X_WS.linear() << 0, 0, 1, 0, 1, 0, -1, 0, 0;  // looks down
  X_WS.translation() = eye_W;
  sim::Frame frame;
  renderer.render(X_WS, frame);
  EXPECT_NEAR(*frame.depth_m.at(20, 15), eye_W.z() + 5, 1e-3);
  return frame.light;
}

TEST(WaterView, BlackTargetsDisappearAtTheVisibility) {
  for (const double visibility_m : {1.0, 10.0, 60.0, 300.0})
    EXPECT_NEAR(sim::water_optics(visibility_m).attenuation.y(), 4.8 / visibility_m, 0.02 / visibility_m);
  // Clear water is blue, and daylight reaches deeper in clear water.
  const sim::WaterOptics clear = sim::water_optics(60), turbid = sim::water_optics(2);
  EXPECT_GT(clear.downward.x(), 5 * clear.downward.z());
  EXPECT_GT(turbid.downward.minCoeff(), clear.downward.minCoeff());
}

TEST(WaterView, HidesTheBottomInTurbidWaterAndShowsItInClearWater) {
  const Sea sea(false);
  const sim::Vector3d eye_W(0.5, 0.5, 2);
  const sim::FloatImage dry = sea_image(sea, eye_W, 0), clear = sea_image(sea, eye_W, 1e6);
  // Without absorption only the 2 % that the surface reflects are missing, and the sky is added.
  EXPECT_NEAR(*clear.at(20, 15), *dry.at(20, 15), 0.04 * *dry.at(20, 15));
  // The lines on the bottom disappear.
  const auto contrast = [](const sim::FloatImage& image) {
    const auto [low, high] = std::minmax_element(image.data.begin(), image.data.end());
    return *high - *low;
  };
  sim::FloatImage turbid = sea_image(sea, eye_W, 1), lines = dry;
  const auto keep_green = [](sim::FloatImage& image) {
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = image.data[i / 3 * 3 + 1];
  };
  keep_green(turbid), keep_green(lines);
  EXPECT_LT(contrast(turbid), 0.1F * contrast(lines));
}

/// A gray wall this far ahead of a camera 4 m under the surface, and the middle pixel of its image.
sim::LinearColor wall_ahead(double distance_m, const sim::WaterLook* look, const std::vector<sim::Lamp>& lamps = {},
                            bool dark = false) {
  const sim::LoadedWorld loaded = sim::load_world_text(
      "shoal: 1\nname: sea\nmedium: {water: {}}\n" +
          std::string(dark ? "light: {sun: 0, sky: 0, zenith_color: \"#000000\", horizon_color: \"#000000\"}\n" : "") +
          "objects: [{name: wall, fixed: true, position_m: [" + std::to_string(distance_m + 0.5) +
          ", 0, -4], parts: [{shape: box, size_m: [1, 50, 50], color: \"#a0a0a0\"}]}]\n",
      "sea.yaml", {});
  sim::InProcessBus bus;
  const sim::World world(loaded.config, bus);
  const sim::Vector3d eye_W(0, 0, -4);
  std::optional<sim::WaterView> water;
  sim::RenderOptions options;
  options.light = loaded.config.light;
  options.lamps = lamps;
  if (look != nullptr) options.water = &water.emplace(world.medium(), loaded.config.light, *look);
  if (water) water->update(eye_W);
  sim::OpticsConfig optics;
  optics.width = 41, optics.height = 31;
  sim::Renderer renderer(world.physics(), sim::make_pixel_rays(sim::Optics(optics), 1), options,
                         std::make_shared<sim::TextureLibrary>());
  sim::Frame frame;
  renderer.render(sim::make_pose(eye_W, {0, 0, 0}), frame);
  const float* rgb = frame.light.at(20, 15);
  return {rgb[0], rgb[1], rgb[2]};
}

const sim::JerlovType all_types[] = {sim::JerlovType::I,   sim::JerlovType::IB, sim::JerlovType::II,
                                     sim::JerlovType::III, sim::JerlovType::C1, sim::JerlovType::C5,
                                     sim::JerlovType::C9};

TEST(WaterLight, FollowsBeerAndLambert) {
  const sim::LightConfig light;
  const double day = light.sky + light.to_sun_W().z() * light.sun;
  for (const sim::JerlovType type : all_types)
    for (const double distance_m : {1.0, 3.0, 10.0}) {
      const sim::WaterLook look{sim::water_optics(type)};
      const sim::LinearColor dry = wall_ahead(distance_m, nullptr), wet = wall_ahead(distance_m, &look);
      for (int i = 0; i < 3; ++i) {
        const double c = look.optics.attenuation[i], at_depth = std::exp(-4.0 * look.optics.downward[i]);
        const double left = std::exp(-c * distance_m);
        const double veil = 0.25 * day * look.optics.scattering[i] * at_depth * (1 - left) / c;
        const double expected = dry[i] * at_depth * left + veil;
        EXPECT_NEAR(wet[i], expected, 0.01 * expected) << distance_m << " m, color " << i;
      }
    }
}

TEST(WaterLight, LampsFollowTheInverseSquareInAir) {
  sim::Lamp lamp;
  lamp.color.setConstant(3);
  const float albedo = sim::linear_from_srgb(0xa0);
  for (const double distance_m : {0.5, 1.0, 4.0}) {
    const sim::LinearColor seen = wall_ahead(distance_m, nullptr, {lamp}, true);
    EXPECT_NEAR(seen.x(), 3 * albedo / (distance_m * distance_m), 1e-4 * seen.x());
  }
  // At half of its width a beam has half of its strength.
  sim::LampConfig config;
  config.rpy_rad = {0, 0, 0.5 * config.beam_rad};
  config.strength = 3;
  EXPECT_NEAR(wall_ahead(1, nullptr, {config.lamp(sim::Pose::Identity())}, true).x(), 1.5 * albedo, 1e-4);
}

TEST(WaterLight, LampsLightTargetAndWater) {
  // A lamp beside the camera.
  sim::Lamp lamp;
  lamp.X_SL.translation() = sim::Vector3d(0, 0.3, 0);
  const double albedo = sim::linear_from_srgb(0xa0);
  for (const sim::JerlovType type : all_types)
    for (const double distance_m : {1.0, 3.0, 10.0}) {
      const sim::WaterLook look{sim::water_optics(type)};
      const sim::LinearColor seen = wall_ahead(distance_m, &look, {lamp}, true);
      for (int i = 0; i < 3; ++i) {
        const double c = look.optics.attenuation[i], molecules = look.optics.molecular[i];
        const double particles = look.optics.scattering[i] - molecules;
        const auto irradiance = [&](double x) {
          const double r = std::hypot(x, 0.3);
          return std::exp(-(1 - x / r) * static_cast<double>(lamp.spread) - c * r) / (r * r);
        };
        // The integral over the path in steps of half a millimeter.
        double veil = 0;
        const double step_m = 0.0005, g = 0.924;
        for (double x = 0.5 * step_m; x < distance_m; x += step_m) {
          const double cosine = -x / std::hypot(x, 0.3);
          const double phase = 0.25 * (1 - g * g) / std::pow(1 + g * g - 2 * g * cosine, 1.5);
          veil += step_m * irradiance(x) * std::exp(-c * x) * (particles * phase + 0.25 * molecules);
        }
        const double toward = distance_m / std::hypot(distance_m, 0.3);
        const double target = albedo * irradiance(distance_m) * toward * std::exp(-c * distance_m);
        EXPECT_NEAR(seen[i], target + veil, 0.02 * (target + veil)) << distance_m << " m, color " << i;
      }
    }
}

}  // namespace
