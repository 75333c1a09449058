// SPDX-License-Identifier: BSD-3-Clause
#include "sim/image/image_file.hpp"

#include <gmock/gmock.h>

#include "sim/random/random.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/image/colored_images.hpp"

namespace {

using namespace colored_images;

using sim::Image8;

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

}  // namespace
