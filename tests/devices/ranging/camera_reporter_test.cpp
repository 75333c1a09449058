// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cstring>

#include "devices/ranging/camera.hpp"
#include "shoal/image_t.hpp"
#include "sim/base/number.hpp"
#include "sim/image/image_file.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/ranging/camera_worlds.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace camera_worlds;

using testing::HasSubstr;

std::span<const std::byte> bytes_of(const shoal::image_t& image) {
  return std::as_bytes(std::span(image.data));
}

TEST(Camera, SeesTheDepthOfAWall) {
  const auto raw = image_of(std::string(small) + ", image: depth", wall_ahead);
  EXPECT_EQ(raw.pixelformat, 842221382);  // FLOAT_GRAY32
  // The chassis frame is at x = 0; it settles by less than 5 mm.
  EXPECT_NEAR(value_at<float>(raw, 32, 24), 3.0, 0.005);
  EXPECT_NEAR(value_at<float>(raw, 2, 24), 3.0, 0.005);  // along the axis, not the ray
  EXPECT_EQ(metadata(raw, "unit"), "m");
  const auto mm = image_of(std::string(small) + ", image: depth, encoding: raw16", wall_ahead);
  EXPECT_EQ(mm.pixelformat, 909199180);  // LE_GRAY16
  EXPECT_NEAR(value_at<std::uint16_t>(mm, 32, 24), 3000, 5);
  EXPECT_EQ(metadata(mm, "unit"), "mm");
  const auto png = image_of(std::string(small) + ", image: depth, encoding: png", wall_ahead);
  EXPECT_NEAR(*sim::decode_png16(bytes_of(png)).at(32, 24), 3000, 5);
  const auto nothing = image_of(std::string(small) + ", image: depth, range_max_m: 2, rpy_deg: [0, -40, 0]");
  EXPECT_EQ(value_at<float>(nothing, 32, 24), INFINITY);
}

TEST(Camera, LabelsCoverTheFaceOfABox) {
  // A face of 1 m x 1 m at 4 m, 50 px of focal length: 12 x 12 px, around 0.5 m of height.
  const std::string box =
      "  - {name: box, fixed: true, position_m: [4.5, 0, 0.5], parts: [{name: b, shape: box, size_m: [1, 1, 1]}]}\n";
  const auto image = image_of(", width: 64, height: 48, focal_px: [48], image: segmentation_vehicles", box);
  EXPECT_EQ(image.pixelformat, 909199180);
  EXPECT_THAT(metadata(image, "labels"), HasSubstr("1 ground\n2 box\n"));
  int pixels = 0;
  for (int row = 0; row < 48; ++row)
    for (int column = 0; column < 64; ++column) pixels += value_at<std::uint16_t>(image, column, row) == 2;
  EXPECT_NEAR(pixels, 144, 12);  // it settles by less than 5 mm, which can cost a row
  const auto parts = image_of(std::string(small) + ", image: segmentation_parts", box);
  EXPECT_THAT(metadata(parts, "labels"), HasSubstr("box/body/b\n"));
}

TEST(Camera, EncodingsHoldTheSameImage) {
  const auto raw = image_of(small, wall_ahead);
  const auto png = image_of(std::string(small) + ", encoding: png", wall_ahead);
  EXPECT_EQ(png.pixelformat, 0x20474e50);  // `PNG `
  const sim::Image8 from_png = sim::decode_image(bytes_of(png));
  ASSERT_EQ(from_png.data.size(), raw.data.size());
  EXPECT_EQ(std::memcmp(from_png.data.data(), raw.data.data(), raw.data.size()), 0);
  const auto jpeg = image_of(std::string(small) + ", encoding: jpeg", wall_ahead);
  EXPECT_EQ(jpeg.pixelformat, 1196444237);  // MJPEG
  EXPECT_LT(jpeg.size, raw.size / 4);
  const sim::Image8 from_jpeg = sim::decode_image(bytes_of(jpeg));
  ASSERT_EQ(from_jpeg.data.size(), raw.data.size());
  double error = 0;
  for (std::size_t i = 0; i < raw.data.size(); ++i)
    error += std::abs(from_jpeg.data[i] - static_cast<std::uint8_t>(raw.data[i]));
  EXPECT_LT(error / static_cast<double>(raw.data.size()), 3);  // levels, of 255
  const auto grey = image_of(std::string(small) + ", image: grey", wall_ahead);
  EXPECT_EQ(grey.pixelformat, 1497715271);  // GRAY
  EXPECT_EQ(grey.size, 64 * 48);
}

TEST(Camera, TheDisparityOfAStereoPairIsFocalLengthTimesBaselineOverDepth) {
  for (const double depth_m : {1.5, 3.0, 8.0}) {
    // A pole of 0.1 m ahead of the middle of both.
    test::TestWorld test(test::rover_world(stereo_pair(labels),
                                           "  - {name: pole, fixed: true, position_m: [" + std::to_string(depth_m) +
                                               ", 0, 0], parts: [{shape: cylinder, radius_m: 0.05, length_m: 10}]}\n"));
    test::Listener<shoal::image_t> lefts(test, "r1.left"), rights(test, "r1.right");
    test.run_for(0.06);
    const auto left = lefts.last(), right = rights.last();
    EXPECT_EQ(left.utime, right.utime);
    const auto column = [](const shoal::image_t& image) {
      double sum = 0;
      int pixels = 0;
      for (int i = 0; i < image.width; ++i)
        if (value_at<std::uint16_t>(image, i, 10) == 2) sum += i + 0.5, ++pixels;  // after the ground
      return sum / pixels;
    };
    const double focal_px = 320 / std::tan(sim::degrees_to_radians(45) / 2);
    EXPECT_NEAR(column(left) - column(right), focal_px * 0.12 / depth_m, 0.5) << depth_m;
    EXPECT_EQ(metadata(left, "baseline_m"), "none");
    EXPECT_NEAR(*sim::read_number(metadata(right, "baseline_m")), 0.12, 1e-12);
  }
}

}  // namespace
