// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/overlay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "shoal/waypoints_command_t.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/experiment/replay/recorded_run.hpp"
#include "tests/scratch_folder.hpp"
#include "viewer/images/overview.hpp"

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
  viewer::Overlay::Settings settings;
  settings.choice.pings = true;
  viewer::Overlay overlay(world, settings, {});
  overlay.add({{100, 0, 0}, 0.01, 0.005, 1500});
  // The silhouette of a sphere of radius r at 100 m, with a focal length of 100 px: 100 r / sqrt(100^2 - r^2), half the
  // width of the line more.
  viewer::SceneView view;
  view.optics.width = 201, view.optics.height = 101;
  view.optics.focal_px = {100};
  view.optics.principal_px = {100.5, 50.5};
  const auto drawn = [&] {
    viewer::RenderedScene rendered{sim::Image8(201, 101, 3), sim::FloatImage(201, 101, 1)};
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

/// Level of the green channel of a pixel.
int green(const sim::Image8& image, int column, int row) {
  return image.at(column, row)[1];
}

TEST(Overlay, DrawsTheRaysOfALaserFromTheSensorToTheHit) {
  // A beam along x from the origin meets a wall at 5 m; the next wall is out of its range.
  const sim::LoadedWorld loaded = sim::load_world_text(
      "shoal: 1\nname: beam\nphysics: {step_s: 0.01, gravity_mps2: 0}\n"
      "objects:\n"
      "  - {name: wall, fixed: true, position_m: [5.5, 0, 0], parts: [{shape: box, size_m: [1, 4, 4]}]}\n"
      "vehicles:\n"
      "  - name: robot\n"
      "    position_m: [0, 0, 0]\n"
      "    model:\n"
      "      shoal: 1\n"
      "      bodies: [{name: body, parts: [{shape: box, size_m: [0.2, 0.2, 0.2], mass_kg: 1}]}]\n"
      "      devices: [{name: laser, type: lidar, beams: 1, rate_hz: 10, phase_s: 0, range_max_m: 20}]\n",
      "beam", {});
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  viewer::Overlay::Settings settings;
  settings.choice = viewer::parse_overlays("rays");
  viewer::Overlay overlay(world, settings, {});
  // From 10 m to the south of (2.5, 0, 0) with a focal length of 100 px: 10 px are 1 m to the east.
  viewer::SceneView view;
  view.optics.width = 201, view.optics.height = 101;
  view.optics.focal_px = {100};
  view.optics.principal_px = {100.5, 50.5};
  view.X_WS = viewer::look_at({2.5, -10, 0}, {2.5, 0, 0});
  const auto drawn = [&] {
    viewer::RenderedScene rendered{sim::Image8(201, 101, 3), sim::FloatImage(201, 101, 1)};
    std::fill(rendered.depth_m.data.begin(), rendered.depth_m.data.end(), std::numeric_limits<float>::infinity());
    overlay.draw(rendered, view);
    return rendered.image;
  };
  overlay.observe();
  EXPECT_EQ(green(drawn(), 100, 50), 0);  // it has not measured yet
  for (int i = 0; i < 15; ++i) {
    world.step();
    overlay.observe_scans();
  }
  // The sensor is at column 100.5 - 25, the hit at 100.5 + 25, with a dot of 4 px.
  const sim::Image8 image = drawn();
  for (const int column : {77, 100, 121}) {
    EXPECT_NEAR(green(image, column, 50), 0.6 * 157, 1) << column;
    EXPECT_EQ(green(image, column, 48), 0) << column;
  }
  EXPECT_EQ(green(image, 73, 50), 0);
  EXPECT_GT(green(image, 125, 50), 140);
  EXPECT_GT(green(image, 125, 49), 100);
  EXPECT_EQ(green(image, 129, 50), 0);
}

/// A log of a path from (-1, 0) to (3, 0), 2 m below the surface, which was published after 0.1 s.
std::string log_of_a_path(const test_support::ScratchFolder& folder, const std::string& world) {
  const std::string log = folder.file("run.lcm");
  test::RecordedRun run(world, log);
  for (int i = 0; i < 10; ++i) run.world.step();
  shoal::waypoints_command_t path{};
  path.utime = run.world.epoch_us() + run.world.now().count();
  path.n = 2;
  path.x_m = {-1, 3};
  path.y_m = {0, 0};
  path.depth_m = {2, 2};
  run.recorder.set_time(run.world.now());
  run.gate.publish("robot.path", shoal::encode(path), run.world.now());
  return log;
}

TEST(Overlay, DrawsThePathOfALogThroughItsPoints) {
  const test_support::ScratchFolder folder;
  const std::string sea = "shoal: 1\nname: sea\nphysics: {step_s: 0.01}\nmedium: {water: {surface_m: 1}}\n";
  const std::string log = log_of_a_path(folder, sea);
  const sim::LoadedWorld loaded = sim::load_world_text(sea, "sea", {});
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  viewer::Overlay::Settings settings;
  settings.choice = viewer::parse_overlays("paths");
  const viewer::Overlay overlay(world, settings, {}, viewer::LogPaths(log, 10));
  // From 10 m to the south of (0, 0, 0) with a focal length of 100 px: 10 px are 1 m.
  viewer::SceneView view;
  view.optics.width = 201, view.optics.height = 101;
  view.optics.focal_px = {100};
  view.optics.principal_px = {100.5, 50.5};
  view.X_WS = viewer::look_at({0, -10, 0}, {0, 0, 0});
  const auto drawn = [&] {
    viewer::RenderedScene rendered{sim::Image8(201, 101, 3), sim::FloatImage(201, 101, 1)};
    std::fill(rendered.depth_m.data.begin(), rendered.depth_m.data.end(), std::numeric_limits<float>::infinity());
    overlay.draw(rendered, view);
    return rendered.image;
  };
  EXPECT_EQ(green(drawn(), 100, 60), 0) << "it has not been published yet";
  for (int i = 0; i < 20; ++i) world.step();
  // z = -1 m: row 60.5; from column 90.5 to 130.5, with dots of 6 px at both ends.
  const sim::Image8 image = drawn();
  for (const int column : {95, 110, 125}) {
    EXPECT_GT(green(image, column, 60), 150) << column;
    EXPECT_EQ(green(image, column, 57), 0) << column;
  }
  for (const int column : {90, 130}) EXPECT_GT(green(image, column, 58), 150) << column;
  EXPECT_EQ(green(image, 85, 60), 0);
  EXPECT_EQ(green(image, 136, 60), 0);
}

TEST(Overlay, NamesWhatItCanDraw) {
  EXPECT_TRUE(viewer::parse_overlays("rays").rays);
  EXPECT_FALSE(viewer::parse_overlays("rays").labels);
  EXPECT_TRUE(viewer::parse_overlays("all").rays);
  EXPECT_TRUE(viewer::parse_overlays("all").paths);
  EXPECT_TRUE(viewer::parse_overlays("paths,clock").paths);
  EXPECT_FALSE(viewer::parse_overlays("trails").paths);
  EXPECT_TRUE(viewer::parse_overlays("rays").any());
  EXPECT_FALSE(viewer::parse_overlays("none").any());
  EXPECT_THROW(viewer::parse_overlays("beams"), std::invalid_argument);
}

}  // namespace
