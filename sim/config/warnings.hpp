// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "sim/config/config_node.hpp"

namespace sim {

/// Input that is valid but probably unintended: logged as one line each, `file:line:column: who: text`.
class Warnings {
 public:
  /// Logs `place: who: text` (place and who may be empty).  The same text at the same place is logged once,
  /// independent of `who`; at most 100 lines are logged.
  void warn(const SourcePlace& place, const std::string& who, const std::string& text);
  /// All that was logged.
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
  std::set<std::string> seen_;
};

/// The place of a key of a map, else that of the map.
SourcePlace place_of(const ConfigNode& map, std::string_view key);

}  // namespace sim
