// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include "autonomy/vision/ball_detector.hpp"
#include "shoal/message_codec.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// An image message of any sizes, in which a program looks for a ball.

SHOAL_FUZZ_TARGET(ball_image) {
  fuzz::Reader reader(input);
  shoal::image_t image{};
  // Small sizes, which fit the bytes, are more frequent than wrong ones.
  const bool any_size = reader.below(8) == 0;
  image.width = any_size ? reader.number<std::int32_t>() : reader.number<std::uint8_t>();
  image.height = any_size ? reader.number<std::int32_t>() : reader.number<std::uint8_t>();
  image.row_stride = any_size ? reader.number<std::int32_t>() : 3 * image.width + static_cast<int>(reader.below(4));
  image.pixelformat = any_size ? reader.number<std::int32_t>() : 859981650;
  const fuzz::Input bytes = reader.rest();
  for (const std::byte byte : bytes) image.data.push_back(std::to_integer<std::uint8_t>(byte));
  // The bytes are repeated, so that a few of them fill an image.
  const std::size_t desired = any_size || bytes.empty() ? 0 : static_cast<std::size_t>(image.row_stride * image.height);
  while (image.data.size() < desired) image.data.push_back(image.data[image.data.size() - bytes.size()]);
  image.size = static_cast<std::int32_t>(image.data.size());
  fuzz::allow<shoal::MessageError>([&] {
    autonomy::BallDetector detector({});
    const auto ball = detector.detect(image);
    if (!ball) return;
    fuzz::require(std::abs(ball->bearing_rad) < std::numbers::pi / 6, "a ball is within the field of view");
    fuzz::require(std::isfinite(ball->range_m) && ball->range_m > 0, "its range is a number");
    fuzz::require(ball->pixels <= image.width * image.height, "it is not larger than the image");
  });
}
