// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/warnings.hpp"

#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"

namespace sim {

/// Returns the line of a text; std::nullopt when it was reported before.
std::optional<std::string> Warnings::new_line(const SourcePlace& place, const std::string& who,
                                              const std::string& text) {
  std::string line = place.text();
  for (const std::string& part : {who, text})
    if (!part.empty()) line += (line.empty() ? "" : ": ") + part;
  // Names are input: line feeds and escape sequences must not reach the terminal.
  line = printable(line);
  // Report an error in a vehicle file once, independent of the number of vehicles that use it.
  if (!seen_.insert(place.line > 0 ? printable(place.text() + ": " + text) : line).second) return std::nullopt;
  return line;
}

void Warnings::warn(const SourcePlace& place, const std::string& who, const std::string& text) {
  constexpr std::size_t max_lines = 100;  // limit of logged warnings
  if (lines_.size() > max_lines) return;
  std::optional<std::string> line = new_line(place, who, text);
  if (!line) return;
  if (lines_.size() == max_lines) line = "more warnings are not shown";
  log_warn("{}", *line);
  lines_.push_back(*std::move(line));
}

void Warnings::note(const SourcePlace& place, const std::string& who, const std::string& text) {
  if (std::optional<std::string> line = new_line(place, who, text)) notes_.push_back(*std::move(line));
}

SourcePlace place_of(const ConfigNode& map, std::string_view key) {
  const ConfigNode* value = map.find(key);
  return value != nullptr ? value->place : map.place;
}

}  // namespace sim
