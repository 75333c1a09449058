// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/csv.hpp"

#include <utility>

namespace experiment {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::optional<std::vector<std::string>> csv_fields(std::string_view line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    // Two quotes in a quoted field stand for one (RFC 4180).
    if (quoted && line[i] == '"') {
      if (i + 1 < line.size() && line[i + 1] == '"')
        fields.back() += line[++i];
      else
        quoted = false;
    } else if (!quoted && line[i] == '"' && fields.back().empty()) {
      quoted = true;
    } else if (!quoted && line[i] == ',') {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return quoted ? std::nullopt : std::optional(std::move(fields));
}

}  // namespace experiment
