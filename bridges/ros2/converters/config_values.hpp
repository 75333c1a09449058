// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "sim/config/config_node.hpp"

namespace bridges::ros2 {

/// Returns the text of a key of a world or a message; empty when there is none.
inline std::string text_at(const sim::ConfigNode& node, std::string_view key) {
  const sim::ConfigNode* value = node.find(key);
  return value != nullptr ? value->scalar : "";
}

inline const std::vector<sim::ConfigNode>& items_at(const sim::ConfigNode& node, std::string_view key) {
  static const std::vector<sim::ConfigNode> none;
  const sim::ConfigNode* list = node.find(key);
  return list != nullptr ? list->items : none;
}

/// Returns a list of numbers, with 0 for what is none.
inline std::vector<double> numbers_at(const sim::ConfigNode& node, std::string_view key) {
  std::vector<double> numbers;
  for (const sim::ConfigNode& item : items_at(node, key)) {
    double number = 0;
    const auto end = std::from_chars(item.scalar.data(), item.scalar.data() + item.scalar.size(), number);
    numbers.push_back(end.ec == std::errc() && std::isfinite(number) ? number : 0);
  }
  return numbers;
}

}  // namespace bridges::ros2
