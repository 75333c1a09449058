// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace bridges {

/// Returns the bytes in base64 (RFC 4648, section 4), with padding.
std::string base64(std::string_view bytes);
/// Returns the bytes of a text in base64 with padding; std::nullopt for any other text.
std::optional<std::string> bytes_of_base64(std::string_view text);

}  // namespace bridges
