// SPDX-License-Identifier: BSD-3-Clause
#include "sim/image/image_file.hpp"
#include "tests/fuzz/fuzz_target.hpp"

// Images of textures: PNG and JPEG.

SHOAL_FUZZ_TARGET(image) {
  fuzz::allow<sim::ImageError>([&] {
    const sim::Image8 image = sim::decode_image(input);
    constexpr std::size_t max_bytes = 100'000;  // compressing large ones takes its time
    if (image.data.size() > max_bytes) return;
    sim::Bytes png;
    sim::encode_png(image, png);
    fuzz::require(sim::decode_image(png).data == image.data, "a PNG holds the same pixels");
  });
  fuzz::allow<sim::ImageError>([&] { sim::decode_png16(input); });
}
