// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace tools {

/// Returns whether the bytes are a PNG file from its signature to its last chunk, with valid checksums.
bool is_whole_png(std::string_view bytes);

}  // namespace tools
