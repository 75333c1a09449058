// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "shoal/message_schema.hpp"

namespace viewer {

/// Largest payload whose fields are shown on a page.
constexpr std::size_t max_shown_payload = std::size_t{8} << 20;

/// Returns the binary frame of kind 2 of the page protocol (docs/develop/view_protocol.md): a message with its fields.
/// A message of an unknown type, an invalid one, and one larger than max_shown_payload have no fields, but their number
/// of bytes.  `time_us`: simulated time of its publication.
std::string message_frame(const shoal::MessageTypes& types, std::string_view channel,
                          std::span<const std::byte> payload, std::int64_t time_us);

}  // namespace viewer
