// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "sim/config/config_node.hpp"

namespace sim {

/// Warning that was found and is given later; see Warnings::warn().
struct Warning {
  SourcePlace place;
  std::string who, text;
};

/// Warnings of input that is valid but probably unintended, each logged as one line: `file:line:column: who: text`; and
/// notes on valid input, which `shoal check` prints.
class Warnings {
 public:
  /// Logs `place: who: text` (place and who may be empty).  The same text at the same place is logged once,
  /// independent of `who`; at most 100 lines are logged.
  void warn(const SourcePlace& place, const std::string& who, const std::string& text);
  void warn(const Warning& warning) { warn(warning.place, warning.who, warning.text); }
  /// Keeps a line in the same form, without logging it.
  void note(const SourcePlace& place, const std::string& who, const std::string& text);
  const std::vector<std::string>& notes() const { return notes_; }
  /// Returns all logged lines.
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::optional<std::string> new_line(const SourcePlace& place, const std::string& who, const std::string& text);

  std::vector<std::string> lines_, notes_;
  std::set<std::string> seen_;
};

/// Returns the place of a key of a map, or of the map when the key is absent.
SourcePlace place_of(const ConfigNode& map, std::string_view key);

}  // namespace sim
