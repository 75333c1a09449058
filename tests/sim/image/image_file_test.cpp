// SPDX-License-Identifier: BSD-3-Clause
#include "sim/image/image_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "sim/random/random.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using sim::Image16;
using sim::Image8;

/// Smooth, so that JPEG keeps it well.
Image8 colors(int width, int height, int channels) {
  Image8 image(width, height, channels);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      for (int channel = 0; channel < channels; ++channel)
        image.at(column, row)[channel] = static_cast<std::uint8_t>((2 * column + 3 * row + 50 * channel) % 200);
  return image;
}

sim::Bytes png_of(const Image8& image) {
  sim::Bytes bytes;
  sim::encode_png(image, bytes);
  return bytes;
}

std::string error_of(std::span<const std::byte> bytes) {
  try {
    sim::decode_image(bytes);
    return "";
  } catch (const sim::ImageError& error) {
    return error.what();
  }
}

TEST(Srgb, IsTheCurveOfTheStandard) {
  EXPECT_EQ(sim::linear_from_srgb(0), 0.0F);
  EXPECT_EQ(sim::linear_from_srgb(255), 1.0F);
  EXPECT_NEAR(sim::linear_from_srgb(188), 0.5029, 1e-4);  // ((188/255 + 0.055) / 1.055)^2.4
  EXPECT_NEAR(sim::linear_from_srgb(10), 10 / 255.0 / 12.92, 1e-7);
  for (int level = 0; level < 256; ++level)
    EXPECT_EQ(sim::srgb_from_linear(sim::linear_from_srgb(static_cast<std::uint8_t>(level))), level);
  EXPECT_EQ(sim::srgb_from_linear(-1), 0);
  EXPECT_EQ(sim::srgb_from_linear(7), 255);
  EXPECT_EQ(sim::srgb_from_linear(std::nanf("")), 0);
}

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

TEST(ImageFile, JpegIsNearlyTheImage) {
  const Image8 image = colors(40, 40, 3);
  sim::Bytes bytes;
  sim::encode_jpeg(image, 95, bytes);
  const Image8 back = sim::decode_image(bytes);
  ASSERT_EQ(back.data.size(), image.data.size());
  double sum = 0;
  for (std::size_t i = 0; i < image.data.size(); ++i) sum += std::abs(back.data[i] - image.data[i]);
  EXPECT_LT(sum / static_cast<double>(image.data.size()), 6);  // colors are stored at half the resolution
}

TEST(ImageFile, GoesThroughFiles) {
  const test_support::ScratchFolder folder;
  const Image8 image = colors(20, 10, 3);
  sim::write_image(folder.file("image.PNG"), image);
  EXPECT_EQ(sim::read_image(folder.file("image.PNG")).data, image.data);
  sim::write_image(folder.file("image.jpg"), image);
  EXPECT_EQ(sim::read_image(folder.file("image.jpg")).width, 20);
  EXPECT_THROW(sim::write_image(folder.file("image.gif"), image), sim::ImageError);
  EXPECT_THROW(sim::write_image(folder.file("no/such/image.png"), image), sim::ImageError);
  EXPECT_THROW(sim::read_image(folder.file("nothing.png")), sim::ImageError);
  EXPECT_THROW(sim::read_image(folder.file("")), sim::ImageError);
}

TEST(ImageFile, RefusesWhatIsNoImage) {
  EXPECT_EQ(error_of({}), "neither PNG nor JPEG");
  const std::string text = "GIF89a and so on";
  EXPECT_EQ(error_of(std::as_bytes(std::span(text))), "neither PNG nor JPEG");
}

TEST(ImageFile, RefusesAHugePngBeforeItTakesMemory) {
  sim::Bytes bytes = png_of(colors(2, 2, 3));
  // Width and height are at 16 and 20; the check sum at 29 would have to fit: 60000 x 60000, by hand.
  const unsigned char header[] = {0, 0, 0xEA, 0x60, 0, 0, 0xEA, 0x60};
  for (std::size_t i = 0; i < 8; ++i) bytes[16 + i] = static_cast<std::byte>(header[i]);
  EXPECT_NE(error_of(bytes), "");
}

/// Every cut and many damaged bytes: an error or an image, never a crash.
void batter(const sim::Bytes& good) {
  // The last bytes of a PNG say no more than that it ends here: libpng has the image by then.
  for (std::size_t size = 0; size + 24 < good.size(); size += 1 + size / 20)
    EXPECT_NE(error_of(std::span(good).first(size)), "") << size;
  sim::Random random(1, "damage");
  for (int i = 0; i < 500; ++i) {
    sim::Bytes bad = good;
    for (int j = 0; j < 3; ++j)
      bad[random.integer_below(static_cast<std::uint32_t>(bad.size()))] = static_cast<std::byte>(random.bits());
    error_of(bad);
  }
}

TEST(ImageFile, SurvivesDamagedFiles) {
  batter(png_of(colors(30, 30, 3)));
  sim::Bytes jpeg;
  sim::encode_jpeg(colors(30, 30, 3), 80, jpeg);
  batter(jpeg);
}

TEST(Pictures, EachLabelHasAColorOfItsOwn) {
  std::set<std::array<std::uint8_t, 3>> colors;
  for (std::uint16_t label = 0; label < 200; ++label) colors.insert(sim::label_color(label));
  EXPECT_GE(colors.size(), 195u);
}

TEST(Pictures, NearIsBrightAndNothingIsBlack) {
  sim::FloatImage depth(3, 1, 1);
  depth.data = {1, 10, INFINITY};
  const Image8 shown = sim::depth_image(depth);
  EXPECT_EQ(shown.data[0], 255);
  EXPECT_EQ(shown.data[1], 40);
  EXPECT_EQ(shown.data[2], 0);
}

}  // namespace
