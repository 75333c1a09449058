// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sim/image/image.hpp"

namespace sim {

/// Throws ImageError for an image that is empty or too large.
void check_image_size(std::uint64_t width, std::uint64_t height);
/// Decodes a JPEG to RGB.  Throws ImageError.
Image8 decode_jpeg(std::span<const std::byte> bytes);

}  // namespace sim
