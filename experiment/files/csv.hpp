// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace experiment {

/// Returns a text as a field of a CSV file (RFC 4180): in quotes if it has a comma, a quote or a line break.
std::string csv_field(const std::string& text);

/// Splits a line of a CSV file into its fields, without their quotes.  std::nullopt if a quote is not closed.
std::optional<std::vector<std::string>> csv_fields(std::string_view line);

}  // namespace experiment
