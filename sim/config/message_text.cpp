// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/message_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <utility>

#include "sim/config/config_node.hpp"

namespace sim {

namespace {

constexpr std::size_t shown_length = 60;

/// Units with which names end, those of the format and those that are written in their place.
constexpr std::string_view units[] = {
    "A",   "Ah",  "C",       "Hz",    "J",   "N",  "Nm",  "Pa",    "V",      "W",   "Wh",  "bps", "cm",
    "dB",  "deg", "degC",    "degps", "dps", "ft", "g",   "h",     "hz",     "kHz", "kPa", "kg",  "km",
    "kmh", "kn",  "knots",   "kph",   "lx",  "m",  "m2",  "m3",    "min",    "mm",  "mph", "mps", "mps2",
    "ms",  "ns",  "percent", "ppm",   "psu", "px", "rad", "radps", "radps2", "rpm", "s",   "uT",  "us"};

/// A unit as text, such as m/s for mps.
std::string unit_text(std::string_view unit) {
  constexpr std::pair<std::string_view, std::string_view> texts[] = {
      {"mps", "m/s"}, {"mps2", "m/s^2"}, {"radps", "rad/s"}, {"radps2", "rad/s^2"}, {"degps", "deg/s"}, {"Nm", "N m"}};
  for (const auto& [name, text] : texts)
    if (name == unit) return std::string(text);
  return std::string(unit);
}

/// A name without the unit at its end, and the unit; empty: it has none.
std::pair<std::string_view, std::string_view> split_unit(std::string_view name) {
  const std::size_t line = name.rfind('_');
  if (line == std::string_view::npos || line == 0) return {name, {}};
  const std::string_view unit = name.substr(line + 1);
  if (std::find(std::begin(units), std::end(units), unit) == std::end(units)) return {name, {}};
  return {name.substr(0, line), unit};
}

std::string escaped(unsigned char c) {
  switch (c) {
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      break;
  }
  char text[8];
  std::snprintf(text, sizeof text, "\\x%02x", c);
  return text;
}

/// Returns the edit distance: number of letters added, removed, changed or swapped with their neighbor.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    // C2 80 to C2 9F are the control characters U+0080 to U+009F; U+009B starts commands like ESC [ does.
    const bool c1 = c == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) >= 0x80 &&
                    static_cast<unsigned char>(text[i + 1]) < 0xa0;
    // E2 80 AA to AE and E2 81 A6 to A9 are U+202A to U+202E and U+2066 to U+2069, which change the direction of
    // writing: the displayed text would differ from the file.
    const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
    const bool turns = c == 0xe2 && ((byte(i + 1) == 0x80 && byte(i + 2) >= 0xaa && byte(i + 2) <= 0xae) ||
                                     (byte(i + 1) == 0x81 && byte(i + 2) >= 0xa6 && byte(i + 2) <= 0xa9));
    if (c1) {
      result += escaped(static_cast<unsigned char>(text[++i]));
    } else if (turns) {
      for (std::size_t k = 0; k < 3; ++k) result += escaped(static_cast<unsigned char>(text[i + k]));
      i += 2;
    } else if (c < 0x20 || c == 0x7f)
      result += escaped(c);
    else
      result += text[i];
  }
  return result;
}

std::string shortened(std::string_view text, std::size_t limit) {
  if (text.size() <= limit) return std::string(text);
  std::size_t end = limit > 3 ? limit - 3 : 0;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return std::string(text.substr(0, end)) + "...";
}

std::string shown(const ConfigNode& node) {
  switch (node.kind) {
    case ConfigNode::Kind::null:
      return "nothing";
    case ConfigNode::Kind::scalar:
      return "'" + shortened(printable(std::string_view(node.scalar).substr(0, 4 * shown_length)), shown_length) + "'";
    default:
      return shortened(printable(to_flow_yaml(node, 2 * shown_length)), shown_length);
  }
}

std::string number_text(double value) {
  char text[40];
  // Plain to_chars prefers 1e+05 to 100000, because it is shorter.
  const bool whole = std::abs(value) < 1e15 && value == std::trunc(value);
  const auto end = whole ? std::to_chars(text, text + sizeof text, static_cast<long long>(value))
                         : std::to_chars(text, text + sizeof text, value);
  return std::string(text, end.ptr);
}

std::string plural_of(std::string_view word) {
  const std::string text(word);
  // "a or b": both words get their plural.
  if (const std::size_t either = text.find(" or "); either != std::string::npos)
    return plural_of(text.substr(0, either)) + " or " + plural_of(text.substr(either + 4));
  const auto ends_with_consonant_y = [&] {
    return text.size() > 1 && text.back() == 'y' &&
           std::string("aeiou").find(text[text.size() - 2]) == std::string::npos;
  };
  if (ends_with_consonant_y()) return text.substr(0, text.size() - 1) + "ies";
  if (word.ends_with("s") || word.ends_with("x") || word.ends_with("ch")) return text + "es";
  return text + "s";
}

std::string with_article(std::string_view word) {
  const bool vowel = !word.empty() && std::string_view("aeiou").find(word.front()) != std::string_view::npos;
  return (vowel ? "an " : "a ") + std::string(word);
}

std::string list_text(const std::vector<std::string>& names, std::size_t max) {
  if (names.empty()) return "none";
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < max; ++i) text += (i == 0 ? "" : ", ") + shortened(names[i]);
  if (names.size() > max) text += ", ... (" + std::to_string(names.size()) + " in all)";
  return text;
}

std::string closest_name(std::string_view misspelled, const std::vector<std::string>& names) {
  std::string closest;
  std::size_t min = std::max<std::size_t>(1, std::min<std::size_t>(3, misspelled.size() / 3)) + 1;
  for (const std::string& name : names) {
    const std::size_t longer = std::max(name.size(), misspelled.size());
    if (longer - std::min(name.size(), misspelled.size()) >= min) continue;
    const std::size_t distance = edit_distance(misspelled, name);
    if (distance >= min || distance >= name.size()) continue;  // one letter is not a misspelling of another
    min = distance;
    closest = name;
  }
  return closest;
}

std::string did_you_mean(std::string_view misspelled, const std::vector<std::string>& names) {
  const auto is_there = [&](std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  // Words of other simulators and of ROS come first: no spelling distance would find them.
  if (const std::string_view here = synonym_of(misspelled); is_there(here))
    return "; did you mean '" + std::string(here) + "'?";
  const auto [stem, unit] = split_unit(misspelled);
  // The same name in another unit is the likeliest mistake, and the value must change with it.
  for (const std::string& name : names) {
    const auto [other_stem, other_unit] = split_unit(name);
    if (other_stem != stem || other_unit == unit) continue;
    const std::string in_unit = unit.empty() || other_unit.empty() ? "" : ", in " + unit_text(other_unit);
    return "; did you mean '" + name + "'" + in_unit + "?";
  }
  const std::string meant = closest_name(misspelled, names);
  return meant.empty() ? "" : "; did you mean '" + meant + "'?";
}

}  // namespace sim
