// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/film/overlay.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world_file/load_world.hpp"

namespace {

/// Width of what is drawn in the middle row, in pixels from the middle; 0: nothing.
int extent(const sim::Image8& image) {
  for (int column = 0; column < image.width / 2; ++column)
    if (*image.at(column, image.height / 2) > 0) return image.width / 2 - column;
  return 0;
}

TEST(Overlay, ShowsSoundWhereItIsNow) {
  const sim::LoadedWorld loaded = sim::load_world_text("shoal: 1\nname: quiet\nphysics: {step_s: 0.01}\n", "quiet", {});
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  tools::Overlay::Settings settings;
  settings.choice.pings = true;
  tools::Overlay overlay(world, settings, {});
  overlay.add({{100, 0, 0}, 0.01, 0.005, 1500});
  // The silhouette of a sphere of radius r at 100 m, with a focal length of 100 px: 100 r / sqrt(100^2 - r^2), half the
  // width of the line more.
  tools::SceneView view;
  view.optics.width = 201, view.optics.height = 101;
  view.optics.focal_px = {100};
  view.optics.principal_px = {100.5, 50.5};
  const auto drawn = [&] {
    tools::RenderedScene rendered{sim::Image8(201, 101, 3), sim::FloatImage(201, 101, 1)};
    std::fill(rendered.depth_m.data.begin(), rendered.depth_m.data.end(), std::numeric_limits<float>::infinity());
    overlay.observe();
    overlay.draw(rendered, view);
    return extent(rendered.image);
  };
  EXPECT_EQ(drawn(), 0);  // it has not started
  for (int i = 0; i < 3; ++i) world.step();
  EXPECT_NEAR(drawn(), 31.4 + 1, 1.5);  // 0.02 s at 1500 m/s: 30 m
  for (int i = 0; i < 2; ++i) world.step();
  EXPECT_NEAR(drawn(), 75 + 1, 1.5);  // 60 m
  while (world.now() < sim::from_seconds(1.5)) world.step();
  EXPECT_EQ(drawn(), 0);  // beyond the range of 2 km
}

}  // namespace
