// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "shoal/message_schema.hpp"

namespace bridges::ros2 {

/// Maximum size of an encoded message.
inline constexpr std::size_t max_cdr_bytes = std::size_t{1} << 28;

/// Transcodes an LCM payload into CDR by its schema, as the type of schema_text().  `out` is replaced.  Returns the
/// error of an invalid payload, or none.
std::optional<std::string> to_cdr(const shoal::MessageSchema& schema, std::span<const std::byte> payload,
                                  std::vector<std::byte>& out);

/// Transcodes CDR of to_cdr(), which may be damaged, back into the LCM payload.  `out` is replaced.  Returns the error
/// of invalid bytes, or none.
std::optional<std::string> from_cdr(const shoal::MessageSchema& schema, std::span<const std::byte> cdr,
                                    std::vector<std::byte>& out);

}  // namespace bridges::ros2
