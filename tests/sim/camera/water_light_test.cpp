// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/water_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/bus/in_process_bus.hpp"
#include "sim/camera/renderer.hpp"
#include "sim/camera/water_view.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/sim/camera/water_view_fixture.hpp"

namespace {

using namespace water_view_fixture;

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
