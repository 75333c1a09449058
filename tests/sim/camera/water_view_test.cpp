// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/water_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/bus/in_process_bus.hpp"
#include "sim/camera/renderer.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace {

/// A world with waves of 1 m, or flat water, over a bottom at a depth of 5 m.
struct Sea {
  explicit Sea(bool waves)
      : loaded(sim::load_world_text(std::string("shoal: 1\nname: sea\nmedium:\n  water: {}\n") +
                                        (waves ? "  waves: {type: jonswap, hs_m: 1, tp_s: 5}\n" : "") +
                                        "objects: [{name: bottom, fixed: true, position_m: [0, 0, -5], parts: [{shape: "
                                        "plane}]}]\n",
                                    "sea.yaml", {})),
        world(loaded.config, bus) {}

  sim::LoadedWorld loaded;
  sim::InProcessBus bus;
  sim::World world;
};

sim::FloatImage sea_image(const Sea& sea, const sim::Vector3d& eye_W, double visibility_m) {
  sim::WaterView water(sea.world.medium(), {}, visibility_m);
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

TEST(WaterView, FindsTheStillSurface) {
  const Sea sea(false);
  sim::WaterView water(sea.world.medium(), {}, 20);
  water.update({0, 0, 3});
  EXPECT_FALSE(water.is_under());
  EXPECT_NEAR(water.crossing_m(sim::Vector3d(0.8, 0, -0.6), 100), 5, 1e-9);
  EXPECT_FALSE(std::isfinite(water.crossing_m(sim::Vector3d(0.8, 0, 0.6), 100)));
  EXPECT_FALSE(std::isfinite(water.crossing_m(sim::Vector3d(0.8, 0, -0.6), 4.9)));
  water.update({0, 0, -3});
  EXPECT_TRUE(water.is_under());
  EXPECT_NEAR(water.crossing_m(sim::Vector3d(0.8, 0, 0.6), 100), 5, 1e-9);
  EXPECT_NEAR(water.daylight(-2).y(), std::exp(-2 * sim::water_optics(20).downward.y()), 1e-3);
}

TEST(WaterView, FindsTheWavesOfTheRun) {
  const Sea sea(true);
  sim::WaterView water(sea.world.medium(), {}, 20);
  const sim::Vector3d eye_W(1, 2, 4);
  water.update(eye_W);
  for (const double yaw_rad : {0.0, 1.0, 2.5, 4.0})
    for (const double down : {0.4, 0.7, 0.95}) {
      const sim::Vector3d direction_W(std::sqrt(1 - down * down) * std::cos(yaw_rad),
                                      std::sqrt(1 - down * down) * std::sin(yaw_rad), -down);
      const double range_m = water.crossing_m(direction_W, 100);
      ASSERT_TRUE(std::isfinite(range_m));
      const sim::Vector3d p_W = eye_W + range_m * direction_W;
      // The grid cannot show waves shorter than 8 points: of 0.6 m and less, with small amplitudes.
      EXPECT_NEAR(p_W.z(), sea.world.medium().surface_m(p_W.x(), p_W.y()), 0.03) << p_W.transpose();
    }
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

}  // namespace
