// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "sim/image/image_file.hpp"

namespace sim {

/// Decodes a PNG to RGB; transparent pixels are blended with black.  Throws ImageError.
Image8 decode_png(std::span<const std::byte> bytes);

}  // namespace sim
