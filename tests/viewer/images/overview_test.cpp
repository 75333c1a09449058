// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/images/overview.hpp"

#include <gtest/gtest.h>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace {

sim::OpticsConfig optics() {
  sim::OpticsConfig config;
  config.width = 1280;
  config.height = 720;
  config.fov_rad = sim::degrees_to_radians(60);
  return config;
}

std::string cube(const char* name, const char* position, const char* size) {
  return std::string("  - {name: ") + name + ", position_m: " + position +
         ", model: {shoal: 1, bodies: [{name: body, parts: [{shape: box, size_m: " + size + ", mass_kg: 1}]}]}}\n";
}

/// Its own view world, kept with the world that it is of.
struct Viewed {
  explicit Viewed(const std::string& text, bool everything = false)
      : loaded(sim::load_world_text("shoal: 1\n" + text, "test", {})),
        world(loaded.config, bus),
        view(viewer::overview_of(world, optics(), everything)) {}

  /// Where a point of the world is in the image; nothing outside of it.
  std::optional<sim::Vector2d> pixel(const sim::Vector3d& p_W) const {
    const auto at = sim::Optics(optics()).project(view.X_WS.inverse() * p_W);
    if (!at || at->x() < 0 || at->y() < 0 || at->x() > 1280 || at->y() > 720) return std::nullopt;
    return at;
  }

  sim::LoadedWorld loaded;
  sim::InProcessBus bus;
  sim::World world;
  viewer::Overview view;
};

TEST(Overview, ShowsAllVehiclesWithTheirSizeAndNoMoreThanTheyNeed) {
  const Viewed viewed(
      "objects: [{name: tower, fixed: true, position_m: [500, 500, 50], parts: [{shape: box, size_m: [9, 9, 100]}]}]\n"
      "vehicles:\n" +
      cube("a", "[0, 0, 1]", "[2, 2, 2]") + cube("b", "[30, 5, 1]", "[1, 8, 1]"));
  for (const double x : {-1, 1})
    for (const double y : {-1, 1})
      for (const double z : {0, 2}) EXPECT_TRUE(viewed.pixel({x, y, z})) << x << ' ' << y << ' ' << z;
  for (const double y : {1, 9}) EXPECT_TRUE(viewed.pixel({30.5, y, 1}));
  EXPECT_FALSE(viewed.pixel({500, 500, 50}));
  // The two fill a good part of the width.
  EXPECT_GT(std::abs(viewed.pixel({-1, 0, 0})->x() - viewed.pixel({30.5, 5, 0})->x()), 600);
  EXPECT_TRUE(viewed.view.hidden.empty());
  EXPECT_TRUE(viewed.view.tiny.empty());
}

TEST(Overview, GoesToAnotherSideWhereAWallIsInTheWay) {
  const std::string wall =
      "objects: [{name: wall, fixed: true, position_m: [-1.5, -1.5, 2], rpy_deg: [0, 0, -45], parts: [{shape: box, "
      "size_m: [9, 0.2, 9]}]}]\n";
  const Viewed viewed(wall + "vehicles:\n" + cube("a", "[0, 0, 1]", "[1, 1, 1]"));
  EXPECT_TRUE(viewed.view.hidden.empty());
  const sim::Vector3d eye_W = viewed.view.X_WS.translation();
  EXPECT_GT(eye_W.x() + eye_W.y(), -3);  // not behind the wall, which is the line x + y = -3
}

TEST(Overview, NamesWhatCannotBeSeen) {
  const std::string box_around =
      "objects: [{name: shed, fixed: true, position_m: [0, 0, 1], parts: [{shape: box, size_m: [2.2, 2.2, 2.2]}]}]\n";
  const Viewed shut_in(box_around + "vehicles:\n" + cube("a", "[0, 0, 1]", "[1, 1, 1]"));
  EXPECT_EQ(shut_in.view.hidden, std::vector<std::string>{"a"});
  const Viewed far_apart("vehicles:\n" + cube("a", "[0, 0, 1]", "[1, 1, 1]") + cube("b", "[3000, 0, 1]", "[1, 1, 1]"));
  EXPECT_EQ(far_apart.view.tiny, (std::vector<std::string>{"a", "b"}));
}

TEST(Overview, FramesObjectsWhenThereIsNothingElseOrWhenAsked) {
  const std::string tower =
      "objects: [{name: tower, fixed: true, position_m: [50, 50, 5], parts: [{shape: box, size_m: [2, 2, 10]}]}]\n";
  EXPECT_TRUE(Viewed(tower).pixel({50, 50, 10}));
  const std::string both = tower + "vehicles:\n" + cube("a", "[0, 0, 1]", "[1, 1, 1]");
  EXPECT_FALSE(Viewed(both).pixel({50, 50, 10}));
  EXPECT_TRUE(Viewed(both, true).pixel({50, 50, 10}));
  EXPECT_TRUE(Viewed(both, true).pixel({0, 0, 1}));
  EXPECT_TRUE(Viewed("").pixel({0, 0, 0}));  // an empty world is not a reason to fail
}

}  // namespace
