// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/param_info.hpp"

#include <cmath>

#include "sim/config/message_text.hpp"

namespace sim {

bool Rule::allows(double value) const {
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Rule::text() const {
  if (low == high) return number_text(low);
  std::string text;
  if (std::isfinite(low)) text = (low_open ? "> " : ">= ") + number_text(low);
  if (std::isfinite(high))
    text += (text.empty() ? "" : " and ") + std::string(high_open ? "< " : "<= ") + number_text(high);
  return text;
}

Rule any_place() {
  return between(-1e7, 1e7);
}

Rule any_number() {
  return {};
}
Rule at_least(double low) {
  return {.low = low};
}
Rule above(double low) {
  return {.low = low, .low_open = true};
}
Rule at_most(double high) {
  return {.high = high};
}
Rule between(double low, double high) {
  return {.low = low, .high = high};
}
Rule above_to(double low, double high) {
  return {.low = low, .high = high, .low_open = true};
}

std::string type_text(ParamKind kind) {
  switch (kind) {
    case ParamKind::any:
      return "any";
    case ParamKind::boolean:
      return "bool";
    case ParamKind::integer:
      return "integer";
    case ParamKind::number:
      return "number";
    case ParamKind::text:
    case ParamKind::name:
      return "text";
    case ParamKind::path:
      return "path";
    case ParamKind::vector:
      return "[x, y, z]";
    case ParamKind::numbers:
      return "list of numbers";
    case ParamKind::texts:
      return "list of text";
    case ParamKind::paths:
      return "list of paths";
    case ParamKind::map:
    case ParamKind::raw:
      return "map";
    case ParamKind::maps:
      return "list of maps";
    case ParamKind::lists:
      return "list of lists";
  }
  return "";
}

}  // namespace sim
