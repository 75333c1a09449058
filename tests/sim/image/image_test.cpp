// SPDX-License-Identifier: BSD-3-Clause
#include "sim/image/image.hpp"

#include <gmock/gmock.h>

#include "sim/image/image_file.hpp"
#include "sim/random/random.hpp"
#include "tests/sim/image/colored_images.hpp"

namespace {

using namespace colored_images;

using sim::Image8;

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
