// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include "sim/image/image_file.hpp"
#include "sim/random/random.hpp"
#include "tests/sim/image/colored_images.hpp"

namespace {

using namespace colored_images;

using sim::Image8;

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

}  // namespace
