// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/param_info.hpp"

#include <algorithm>
#include <cmath>
#include <map>

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

std::vector<ParamInfo> merged_keys(const std::vector<std::pair<std::string, std::vector<ParamInfo>>>& types) {
  std::vector<ParamInfo> keys;
  std::map<std::string, std::vector<std::string>> owners;
  for (const auto& [word, table] : types)
    for (const ParamInfo& info : table) {
      owners[info.key].push_back(word);
      const auto same = [&](const ParamInfo& other) { return other.key == info.key; };
      if (std::any_of(keys.begin(), keys.end(), same)) continue;
      keys.push_back(info);
      ParamInfo& merged = keys.back();
      const bool is_text = merged.kind == ParamKind::text || merged.kind == ParamKind::name;
      if (merged.required && is_text && merged.choices.empty()) merged.initial = "\"\"";  // for types without this key
      merged.required = false;
    }
  for (ParamInfo& info : keys) {
    const std::vector<std::string>& whose = owners[info.key];
    if (whose.size() == 2) info.meaning = whose[0] + ", " + whose[1] + ": " + info.meaning;
    if (whose.size() == 1 && whose[0] != info.key) info.meaning = whose[0] + ": " + info.meaning;
  }
  return keys;
}

namespace {

using Row = std::array<std::string, 5>;

std::string default_text(const ParamInfo& param) {
  if (param.required) return "required";
  return param.initial == "~" ? "unset" : param.initial;
}

void append_rows(const std::vector<ParamInfo>& params, const std::string& prefix, std::vector<Row>& rows) {
  for (const ParamInfo& param : params) {
    rows.push_back({prefix + param.key, param.type, param.rule, default_text(param), param.meaning});
    const bool is_list = param.type.starts_with("list") && !param.main_alone;
    append_rows(param.children, prefix + param.key + (is_list ? "[]." : "."), rows);
  }
}

/// Returns the text with cell borders and tags of Markdown escaped.
std::string escaped_for_markdown(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '>' || c == '*') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

/// Returns a cell formatted as code, in which only the border needs escaping.
std::string code(const std::string& text) {
  if (text.empty()) return "";
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return "`" + escaped + "`";
}

std::size_t characters(const std::string& text) {
  const auto starts_character = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts_character));
}

}  // namespace

std::vector<std::array<std::string, 5>> param_rows(const std::vector<ParamInfo>& params) {
  std::vector<Row> rows;
  append_rows(params, "", rows);
  for (Row& row : rows)
    for (std::string& cell : row) cell = printable(cell);
  return rows;
}

std::string markdown_table(const std::vector<ParamInfo>& params) {
  std::string text = "| key | type | rule | default | meaning |\n|---|---|---|---|---|\n";
  for (const Row& row : param_rows(params)) {
    const bool is_value = row[3] != "required" && row[3] != "unset";
    text += "| " + code(row[0]) + " | " + escaped_for_markdown(row[1]) + " | " + escaped_for_markdown(row[2]) + " | " +
            (is_value ? code(row[3]) : row[3]) + " | " + escaped_for_markdown(row[4]) + " |\n";
  }
  return text;
}

std::string text_table(const std::vector<ParamInfo>& params) {
  std::vector<Row> rows = param_rows(params);
  rows.insert(rows.begin(), Row{"key", "type", "rule", "default", "meaning"});
  std::array<std::size_t, 5> width{};
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], characters(row[i]));
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += row[i] + std::string(i + 1 < row.size() ? width[i] - characters(row[i]) + 2 : 0, ' ');
    // Lines end without blanks, so that the text can be compared and pasted.
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace sim
