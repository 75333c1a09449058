// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/checks.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "sim/config/message_text.hpp"

namespace command_line {

namespace {

/// Returns the input, safe to print on one line.
/// Returns the whole text as a number; std::nullopt for any other text.
template <class Number>
std::optional<Number> parse_number(const std::string& text) {
  Number number{};
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(begin, end, number);
  if (error != std::errc{} || at != end) return std::nullopt;
  return number;
}

CLI::Validator make_check(const std::string& description, const std::function<bool(const std::string&)>& good,
                          const std::string& rule) {
  return CLI::Validator(
      [good, rule](const std::string& text) { return good(text) ? "" : rule + ", got " + quoted(text); }, description);
}

}  // namespace

std::string bound_text(double bound) {
  if (std::abs(bound) < 1e6 && std::abs(bound) >= 1e-4) return fmt::format("{:g}", bound);
  // Remove the plus sign and zeros of the exponent: 1e9, not 1e+09.
  std::string text = fmt::format("{:g}", bound);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  const std::size_t sign = exponent + 1, digits = text.find_first_not_of('0', sign + 1);
  text.erase(sign + 1, std::min(digits, text.size() - 1) - (sign + 1));
  if (text[sign] == '+') text.erase(sign, 1);
  return text;
}

CLI::Validator number_from(double low, double high) {
  const std::string range = fmt::format("from {} to {}", bound_text(low), bound_text(high));
  const auto good = [low, high](const std::string& text) {
    const auto number = parse_number<double>(text);
    return number && *number >= low && *number <= high;
  };
  return make_check(range, good, "must be " + range);
}

CLI::Validator number_or_word(double low, double high, const std::string& word) {
  const std::string range = fmt::format("from {} to {}, or {}", bound_text(low), bound_text(high), word);
  const auto take = [low, high, range, word](std::string& text) -> std::string {
    if (text == word) {
      text = "0";
      return "";
    }
    const auto number = parse_number<double>(text);
    return number && *number >= low && *number <= high ? ""
                                                       : "must be " + range + ", got " + quoted(std::as_const(text));
  };
  return {take, range};
}

CLI::Validator whole_from(std::int64_t low, std::int64_t high) {
  const std::string range = fmt::format("from {} to {}", low, high);
  const auto good = [low, high](const std::string& text) {
    const auto number = parse_number<std::int64_t>(text);
    return number && *number >= low && *number <= high;
  };
  return make_check(range, good, "must be a whole number " + range);
}

std::string alternatives(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

CLI::Validator one_of(std::vector<std::string> words) {
  const std::string known = alternatives(words);
  const auto check = [words = std::move(words), known](const std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return "";
    return "must be " + known + ", got " + quoted(text) + sim::did_you_mean(text, words);
  };
  return CLI::Validator(check, known);
}

CLI::Validator seed() {
  return whole_from(0, std::numeric_limits<std::int64_t>::max()).description("from 0 to 2^63 - 1");
}

CLI::Validator setting() {
  const auto good = [](const std::string& text) {
    const std::size_t equals = text.find('=');
    return equals != std::string::npos && equals > 0;
  };
  return make_check("", good, "must be PATH=VALUE, such as run.seed=3");
}

CLI::Validator not_empty() {
  return make_check(
      "", [](const std::string& text) { return !text.empty(); }, "must not be empty");
}

std::string quoted(const std::string& text) {
  return "'" + sim::shortened(sim::printable(sim::shortened(text, 240))) + "'";
}

}  // namespace command_line
