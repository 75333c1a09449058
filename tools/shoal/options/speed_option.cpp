// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/options/speed_option.hpp"

#include <CLI/App.hpp>

#include "sim/base/number.hpp"

namespace tools {

std::optional<double> parse_speed(const std::string& text) {
  if (text.empty()) return std::nullopt;
  if (text == "max") return 0.0;
  if (const auto speed = sim::read_number(text); speed && *speed >= 0.001 && *speed <= 1e6) return speed;
  throw CLI::ValidationError("--speed", "must be from 0.001 to 1e6, or max, got '" + text + "'");
}

}  // namespace tools
