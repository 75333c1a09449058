// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/presets.hpp"

namespace sim {

Presets::Presets(const std::string& file, std::string_view text) {
  Diagnostics diagnostics;
  root_ = parse_config_text(std::string(text), file, diagnostics);
  diagnostics.throw_if_any();
}

std::vector<std::string> Presets::names() const {
  std::vector<std::string> names;
  for (const ConfigNode::Entry& entry : root_.entries) names.push_back(entry.key);
  return names;
}

}  // namespace sim
