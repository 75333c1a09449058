// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/renderer.hpp"

#include <gmock/gmock.h>

#include "sim/image/image_file.hpp"
#include "tests/sim/camera/rendered_worlds.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace rendered_worlds;
using namespace small_worlds;

using sim::degrees_to_radians;
using sim::Frame;
using sim::ImageKind;

sim::RenderOptions of_kind(ImageKind kind) {
  sim::RenderOptions options;
  options.kind = kind;
  return options;
}

PartConfig painted(PartConfig part, const std::string& color) {
  part.color = color;
  return part;
}

int count(const sim::Image16& labels, int label) {
  return static_cast<int>(std::count(labels.data.begin(), labels.data.end(), label));
}

TEST(Renderer, TheDiscOfASphereHasTheRadiusOfItsTangentCone) {
  auto world = make_world();
  add(*world, body("ball", {sphere(1, 0)}), translation(5, 0, 0), Motion::fixed);
  const Frame frame = render(*world, Pose::Identity(), of_kind(ImageKind::groups));
  const double radius_px = 200 * std::tan(std::asin(1 / 5.0));  // 40.8 px
  const double area = std::numbers::pi * radius_px * radius_px;
  // Gauss's circle problem: the error of a count of pixel centers stays far below the circumference.
  EXPECT_NEAR(count(frame.labels, 1), area, 0.25 * 2 * std::numbers::pi * radius_px);
  int across = 0;
  for (int u = 0; u < 200; ++u) across += *frame.labels.at(u, 75) != 0;
  EXPECT_NEAR(across, 2 * radius_px, 1.5);
}

TEST(Renderer, DepthOfATiltedPlaneIsItsClosedForm) {
  auto world = make_world();
  // Through (4, 0, 0), its normal turned 30 degrees from the camera.
  const double tilt = degrees_to_radians(30);
  add(*world, body("wall", {plane()}), sim::make_pose({4, 0, 0}, {0, -std::numbers::pi / 2 + tilt, 0}), Motion::fixed);
  sim::RenderOptions options = of_kind(ImageKind::depth);
  const Frame axis = render(*world, Pose::Identity(), options);
  options.depth_along_ray = true;
  const Frame range = render(*world, Pose::Identity(), options);
  const sim::Optics optics(lens());
  const Vector3d normal_W = sim::rotation_from_rpy({0, -std::numbers::pi / 2 + tilt, 0}).col(2);
  for (const auto& [u, v] : {std::pair(100, 75), std::pair(3, 10), std::pair(190, 140), std::pair(60, 149)}) {
    const Vector3d direction = *optics.direction_S(u + 0.5, v + 0.5);
    const double expected_m = Vector3d(4, 0, 0).dot(normal_W) / direction.dot(normal_W);
    EXPECT_NEAR(*range.depth_m.at(u, v), expected_m, 2e-6 * expected_m);  // float
    EXPECT_NEAR(*axis.depth_m.at(u, v), expected_m * direction.x(), 2e-6 * expected_m);
  }
}

TEST(Renderer, DepthIsInfiniteWhereThereIsNothingInRange) {
  auto world = make_world();
  add(*world, body("box", {box({1, 1, 1}, 0)}), translation(5, 0, 0), Motion::fixed);
  sim::RenderOptions options = of_kind(ImageKind::depth);
  EXPECT_NEAR(*render(*world, Pose::Identity(), options).depth_m.at(100, 75), 4.5, 1e-5);
  EXPECT_EQ(*render(*world, Pose::Identity(), options).depth_m.at(0, 0), INFINITY);
  options.range_max_m = 4;
  EXPECT_EQ(*render(*world, Pose::Identity(), options).depth_m.at(100, 75), INFINITY);
}

TEST(Renderer, AWhiteFloorIsAsBrightAsLambertSays) {
  auto world = make_world();
  add(*world, body("floor", {painted(plane(), "#ffffff")}), Pose::Identity(), Motion::fixed);
  sim::RenderOptions options = sun_in_the_west(30);
  const Frame frame = render(*world, looking_down(0, 0, 3), options);
  const float* rgb = frame.light.at(100, 75);
  EXPECT_NEAR(rgb[0], 0.5, 1e-6);  // the sine of 30 degrees
  EXPECT_NEAR(rgb[1] / rgb[0], 0.97, 1e-5);
  // 0.5 in linear light is level 188 in sRGB.
  EXPECT_EQ(sim::develop(frame.light, 1).at(100, 75)[0], 188);
  options.light.sun_elevation_rad = degrees_to_radians(-5);
  EXPECT_EQ(render(*world, looking_down(0, 0, 3), options).light.at(100, 75)[0], 0);
}

TEST(Renderer, AShadowEndsWhereTheSunsHeightSays) {
  auto world = make_world();
  add(*world, body("floor", {painted(plane(), "#ffffff")}), Pose::Identity(), Motion::fixed);
  // 1 m high, its east side at x = 0: under a sun in the west at 45 degrees the shadow ends at x = 1.
  add(*world, body("wall", {box({0.2, 4, 1}, 0)}), translation(-0.1, 0, 0.5), Motion::fixed);
  const Frame frame = render(*world, looking_down(0.5, 0, 4), sun_in_the_west(45));
  // 200 px / 4 m: 50 px a meter on the floor; the column of x is 100 + 50 (x - 0.5).
  EXPECT_EQ(frame.light.at(100, 75)[0], 0);
  EXPECT_EQ(frame.light.at(123, 75)[0], 0);     // x = 0.97
  EXPECT_GT(frame.light.at(126, 75)[0], 0.5F);  // x = 1.03
  sim::RenderOptions without = sun_in_the_west(45);
  without.light.shadows = false;
  EXPECT_GT(render(*world, looking_down(0.5, 0, 4), without).light.at(100, 75)[0], 0.5F);
}

TEST(Renderer, ALitSurfaceDoesNotShadeItself) {
  auto world = make_world();
  add(*world, body("ball", {painted(sphere(1, 0), "#ffffff")}), translation(5000, 3000, 1), Motion::fixed);
  sim::RenderOptions options = sun_in_the_west(40);
  const Frame frame = render(*world, sim::make_pose({4995, 3000, 1}, Vector3d::Zero()), options);
  // The camera looks east at the side that the sun lights: nothing of the upper half is dark.
  for (int v = 40; v < 75; ++v) EXPECT_GT(frame.light.at(100, v)[0], 0.1F) << v;
}

TEST(Renderer, LabelsCoverTheFaceOfABox) {
  auto world = make_world();
  add(*world, body("floor", {plane()}), translation(0, 0, -100), Motion::fixed);
  auto left = box({1, 1, 1}, 0);
  left.name = "left";
  left.position_m = {0, 0.5, 0};
  auto right = left;
  right.name = "right";
  right.position_m = {0, -0.5, 0};
  add(*world, body("pair", {left, right}), translation(4.5, 0, 0), Motion::fixed);
  const Frame parts = render(*world, Pose::Identity(), of_kind(ImageKind::parts));
  // A face of 1 m x 1 m at 4 m: 50 x 50 px.
  EXPECT_EQ(count(parts.labels, 2), 2500);
  EXPECT_EQ(count(parts.labels, 3), 2500);
  EXPECT_EQ(*parts.labels.at(80, 75), 2);  // left in the image is +y
  EXPECT_EQ(*parts.labels.at(120, 75), 3);
  EXPECT_EQ(sim::Renderer::label_name(*world, ImageKind::parts, 2), "pair/pair/left");
  const Frame groups = render(*world, Pose::Identity(), of_kind(ImageKind::groups));
  EXPECT_EQ(count(groups.labels, 2), 5000);
  EXPECT_EQ(sim::Renderer::label_name(*world, ImageKind::groups, 2), "pair");
  EXPECT_EQ(sim::Renderer::label_name(*world, ImageKind::groups, 0), "nothing");
}

TEST(Renderer, LabelsBeyond65534AreOne) {
  std::vector<PartConfig> crowd(65534, sphere(0.01, 0));
  for (std::size_t i = 0; i < crowd.size(); ++i) crowd[i].name = "p" + std::to_string(i);
  for (const double side : {1.0, -1.0}) {
    crowd.push_back(box({1, 1, 1}, 0));
    crowd.back().name = side > 0 ? "left" : "right";
    crowd.back().position_m = {-95.5, 0.5 * side, 0};
  }
  auto world = make_world();
  add(*world, body("crowd", crowd), translation(100, 0, 0), Motion::fixed);
  const Frame parts = render(*world, Pose::Identity(), of_kind(ImageKind::parts));
  EXPECT_EQ(*parts.labels.at(80, 75), 65535);
  EXPECT_EQ(*parts.labels.at(120, 75), 65535);
}

TEST(Renderer, WhatLetsLightThroughIsNotSeen) {
  MaterialConfig glass;
  glass.name = "glass";
  glass.transparent_to = {"light"};
  auto world = world_of(glass);
  PartConfig pane = box({0.1, 4, 4}, 0);
  pane.material = "glass";
  add(*world, body("pane", {pane}), translation(2, 0, 0), Motion::fixed);
  add(*world, body("wall", {box({0.1, 4, 4}, 0)}), translation(4, 0, 0), Motion::fixed);
  EXPECT_EQ(*render(*world, Pose::Identity(), of_kind(ImageKind::groups)).labels.at(100, 75), 2);
}

TEST(Renderer, AntialiasingTakesTheMeanOfAPixel) {
  auto world = make_world();
  // The edge of a black box runs through the middle of column 100, before a white sky.
  add(*world, body("box", {painted(box({1, 10, 10}, 0), "#000000")}), translation(2.5, 5 - 0.5 / 200 * 2, 0),
      Motion::fixed);
  sim::RenderOptions options;
  options.light.sun = 0;
  options.light.zenith_color = options.light.horizon_color = "#ffffff";
  const Frame frame = render(*world, Pose::Identity(), options, 4);
  EXPECT_NEAR(frame.light.at(100, 30)[0], 0.5, 1e-5);
  EXPECT_EQ(frame.light.at(99, 30)[0], 0);
  EXPECT_NEAR(frame.light.at(101, 30)[0], 1, 1e-5);
}

TEST(Renderer, RowsMayBeRenderedOneByOne) {
  auto world = make_world();
  add_ground(*world);
  add(*world, body("ball", {sphere(1, 0)}), translation(5, 0, 1), Motion::fixed);
  const Pose X_WS = translation(0, 0, 1);
  const Frame whole = render(*world, X_WS, {}, 3);
  sim::Renderer renderer(*world, sim::make_pixel_rays(sim::Optics(lens()), 3), {},
                         std::make_shared<sim::TextureLibrary>());
  Frame rows;
  renderer.clear(rows);
  for (int row = 0; row < 150; ++row) renderer.render_rows(X_WS, row, row + 1, 1, rows);
  EXPECT_EQ(rows.light.data, whole.light.data);
}

TEST(Renderer, AutoGainMakesAMiddleGrey) {
  sim::FloatImage light(2, 1, 3);
  light.data = {0.02F, 0.02F, 0.02F, 0.04F, 0.04F, 0.04F};
  EXPECT_NEAR(sim::auto_gain(light), 6, 1e-4);
}

}  // namespace
