// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "shoal/image_t.hpp"
#include "sim/image/image.hpp"

namespace tools {

/// An image that a camera reported, for people to look at.  Throws std::runtime_error when its size, format and data
/// do not fit together; sim::ImageError when what is compressed is damaged.
sim::Image8 displayable(const shoal::image_t& message);

}  // namespace tools
