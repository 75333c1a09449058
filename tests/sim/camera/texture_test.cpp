// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/texture.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "sim/camera/renderer.hpp"
#include "sim/image/image_file.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/camera/rendered_worlds.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace rendered_worlds;
using namespace small_worlds;

using sim::Frame;

TEST(Renderer, CheckersHaveTheirCornersAtWholeFields) {
  MaterialConfig tiles;
  tiles.name = "tiles";
  tiles.texture.pattern = sim::TextureConfig::Pattern::checker;
  tiles.texture.colors = {"#ffffff", "#000000"};
  tiles.texture.size_m = 0.5;
  auto world = world_of(tiles);
  PartConfig floor = plane();
  floor.material = "tiles";
  add(*world, body("floor", {floor}), Pose::Identity(), Motion::fixed);
  const Frame frame = render(*world, looking_down(0, 0, 4), sun_in_the_west(80));
  // 25 px a field; the first one is right of and above the middle, and white.
  const auto white = [&](int u, int v) { return frame.light.at(u, v)[0] > 0.5F; };
  EXPECT_TRUE(white(102, 72));
  EXPECT_TRUE(white(122, 53));
  EXPECT_FALSE(white(127, 72));
  EXPECT_FALSE(white(102, 47));
  EXPECT_TRUE(white(127, 47));
  EXPECT_FALSE(white(97, 72));
  EXPECT_TRUE(white(97, 77));
}

TEST(Renderer, AnImageLiesUprightOnAWall) {
  const test_support::ScratchFolder folder;
  const std::string file = folder.file("poster.png");
  sim::Image8 image(2, 2, 3);
  image.data = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};  // red green / blue white
  sim::write_image(file, image);
  MaterialConfig poster;
  poster.name = "poster";
  poster.texture.pattern = sim::TextureConfig::Pattern::image;
  poster.texture.file = file;
  poster.texture.size_m = 2;
  auto world = world_of(poster);
  PartConfig wall = box({0.2, 2, 2}, 0);
  wall.material = "poster";
  // Seen from -y, u along x grows to the right; the lower left corner of the image is at the origin of the part.
  wall.size_m = {2, 0.2, 2};
  add(*world, body("wall", {wall}), Pose::Identity(), Motion::fixed);
  sim::RenderOptions options;
  options.light.sun = 0;
  options.light.sky = 1;
  const Frame frame = render(*world, sim::make_pose({0, -4, 0}, {0, 0, std::numbers::pi / 2}), options);
  const auto at = [&](double x, double z) {
    const float* rgb = frame.light.at(static_cast<int>(100 + 200 * x / 3.9), static_cast<int>(75 - 200 * z / 3.9));
    return std::string(rgb[0] > 0.3F ? "r" : "") + (rgb[1] > 0.3F ? "g" : "") + (rgb[2] > 0.3F ? "b" : "");
  };
  EXPECT_EQ(at(0.5, 0.5), "b");     // blue, the lower left pixel
  EXPECT_EQ(at(-0.5, 0.5), "rgb");  // its right neighbor, repeated
  EXPECT_EQ(at(0.5, -0.5), "r");    // from below: the top row again
  EXPECT_EQ(at(-0.5, -0.5), "g");
}

TEST(Renderer, SaysWhichTextureCannotBeRead) {
  const test_support::ScratchFolder folder;
  const std::string file = folder.file("broken.png");
  std::ofstream(file) << "no image";
  MaterialConfig poster;
  poster.name = "poster";
  poster.texture.pattern = sim::TextureConfig::Pattern::image;
  poster.texture.file = file;
  auto world = world_of(poster);
  PartConfig wall = box({1, 1, 1}, 0);
  wall.material = "poster";
  add(*world, body("wall", {wall}), Pose::Identity(), Motion::fixed);
  try {
    render(*world, Pose::Identity(), {});
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("material 'poster': texture '"));
    EXPECT_THAT(error.what(), testing::HasSubstr("broken.png': neither PNG nor JPEG"));
  }
}

}  // namespace
