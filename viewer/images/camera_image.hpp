// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "shoal/image_t.hpp"
#include "sim/image/image.hpp"

namespace viewer {

/// Converts the image of a camera message to a displayable one.  Throws std::runtime_error when its size, format and
/// data are inconsistent; sim::ImageError when compressed data is damaged.
sim::Image8 displayable(const shoal::image_t& message);

}  // namespace viewer
