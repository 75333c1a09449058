// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/image_t.hpp"
#include "tests/bridges/ros2/converted.hpp"
#include "tests/bridges/ros2/known_devices.hpp"

namespace {

using namespace known_devices;
using namespace bridges::ros2;

using test::converted;
using test::expect_header;

TEST(Ros2Converter, ImagesAreRawOrCompressedByTheirFormat) {
  shoal::image_t image{};
  image.utime = 1'500'000;
  image.width = 2;
  image.height = 1;
  image.row_stride = 6;
  image.pixelformat = 859981650;  // RGB
  image.size = 6;
  image.data = {1, 2, 3, 4, 5, 6};
  auto in = converted(image, "image");
  EXPECT_FALSE(converted(image, "compressed"));
  expect_header(*in, "auv1/x_optical");
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);
  EXPECT_EQ(in->number<std::uint32_t>(), 2u);
  EXPECT_EQ(in->text(), "rgb8");
  EXPECT_EQ(in->number<std::uint8_t>(), 0);
  EXPECT_EQ(in->number<std::uint32_t>(), 6u);
  EXPECT_EQ(in->number<std::uint32_t>(), 6u);
  image.row_stride = 5;
  EXPECT_FALSE(converted(image, "image"));  // rows overlap
  image.pixelformat = 1196444237;           // JPEG
  auto jpeg = converted(image, "compressed");
  expect_header(*jpeg, "auv1/x_optical");
  EXPECT_EQ(jpeg->text(), "jpeg");
}

TEST(RosConventions, SixteenBitsAreBrightnessDepthsOrLabels) {
  constexpr std::int32_t le_grey16 = 909199180, png = 541544016;
  const auto encoding = [](const std::string& key) {
    auto in = converted(image_of(le_grey16, key, "mm"), "image");
    expect_header(*in, "auv1/x_optical");
    in->skip<std::uint32_t>(2);
    return in->text();
  };
  EXPECT_EQ(encoding("exposure"), "mono16");
  EXPECT_EQ(encoding("unit"), "16UC1");  // REP 118
  EXPECT_EQ(encoding("labels"), "16UC1");
  auto in = converted(image_of(png, "unit", "mm"), "compressed");
  expect_header(*in, "auv1/x_optical");
  EXPECT_EQ(in->text(), "16UC1; png compressed ");
}

}  // namespace
