// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "sim/image/image_file.hpp"
#include "sim/random/random.hpp"
#include "tests/sim/image/colored_images.hpp"

namespace {

using namespace colored_images;

using sim::Image16;
using sim::Image8;

TEST(ImageFile, PngKeepsEveryLevel) {
  const Image8 image = colors(33, 17, 3);
  const Image8 back = sim::decode_image(png_of(image));
  EXPECT_EQ(back.width, 33);
  EXPECT_EQ(back.height, 17);
  EXPECT_EQ(back.data, image.data);
}

TEST(ImageFile, AGreyPngIsReadAsRgb) {
  const Image8 grey = colors(5, 4, 1);
  const Image8 back = sim::decode_image(png_of(grey));
  ASSERT_EQ(back.data.size(), 3 * grey.data.size());
  for (std::size_t i = 0; i < back.data.size(); ++i) EXPECT_EQ(back.data[i], grey.data[i / 3]);
}

TEST(ImageFile, APngOf16BitsKeepsEveryBit) {
  Image16 image(64, 3, 1);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<std::uint16_t>(i * 341);
  sim::Bytes bytes;
  sim::encode_png(image, bytes);
  EXPECT_EQ(sim::decode_png16(bytes).data, image.data);
}

TEST(ImageFile, RefusesAHugePngBeforeItTakesMemory) {
  sim::Bytes bytes = png_of(colors(2, 2, 3));
  // Width and height are at 16 and 20; the check sum at 29 would have to fit: 60000 x 60000, by hand.
  const unsigned char header[] = {0, 0, 0xEA, 0x60, 0, 0, 0xEA, 0x60};
  for (std::size_t i = 0; i < 8; ++i) bytes[16 + i] = static_cast<std::byte>(header[i]);
  EXPECT_NE(error_of(bytes), "");
}

}  // namespace
