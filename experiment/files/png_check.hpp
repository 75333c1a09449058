// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace experiment {

/// Returns whether the bytes are a PNG file from its signature to its last chunk, in which each checksum is valid.
bool is_whole_png(std::string_view bytes);

}  // namespace experiment
