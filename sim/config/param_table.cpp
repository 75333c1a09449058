// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/param_table.hpp"

#include <algorithm>

#include "sim/config/message_text.hpp"

namespace sim {

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
