// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace tools {

/// The bytes are a PNG file from its signature to its last chunk, and the checksum of each chunk is right.
bool is_whole_png(std::string_view bytes);

}  // namespace tools
