// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace viewer {

/// Request `look` of a page: the poses at a time.
struct LookRequest {
  std::optional<std::int64_t> time_us;  ///< unset: the page shows the present again
  std::optional<std::int32_t> branch;   ///< unset: the present one
};

/// Reads a request.  Throws std::runtime_error with the key, the rule and the value.
LookRequest parse_look(std::string_view text);

}  // namespace viewer
