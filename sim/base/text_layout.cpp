// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/text_layout.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

namespace sim {

namespace {

constexpr int min_columns = 40, max_columns = 1000, usual_columns = 80;

bool starts_character(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
}

}  // namespace

int text_columns(int file_descriptor) {
  int columns = 0;
  // COLUMNS goes first: scripts and tests set it to get the same layout everywhere.
  if (const char* text = std::getenv("COLUMNS")) {
    const char* end = text + std::strlen(text);
    const auto [at, error] = std::from_chars(text, end, columns);
    if (error != std::errc{} || at != end) columns = 0;
  }
  winsize size{};
  if (columns <= 0 && ioctl(file_descriptor, TIOCGWINSZ, &size) == 0) columns = size.ws_col;
  if (columns <= 0) columns = usual_columns;
  return std::clamp(columns, min_columns, max_columns);
}

bool can_move_cursor(int file_descriptor) {
  const char* terminal = std::getenv("TERM");
  return isatty(file_descriptor) != 0 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

bool may_use_color(int file_descriptor) {
  const char* no_color = std::getenv("NO_COLOR");
  return can_move_cursor(file_descriptor) && (no_color == nullptr || *no_color == '\0');
}

std::size_t column_count(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts_character));
}

std::string cut_to(std::string_view text, std::size_t columns) {
  if (column_count(text) <= columns) return std::string(text);
  const std::size_t keep = columns > 3 ? columns - 3 : 0;
  std::size_t end = 0, characters = 0;
  for (; end < text.size(); ++end)
    if (starts_character(text[end]) && characters++ == keep) break;
  return std::string(text.substr(0, end)) + std::string("...").substr(0, std::min<std::size_t>(3, columns));
}

std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent, std::size_t starts_at) {
  std::string result;
  std::size_t used = starts_at;
  bool first_of_line = true;
  for (std::size_t at = 0; at < text.size();) {
    // Skip spaces.
    if (text[at] == ' ') {
      ++at;
      continue;
    }
    // Append the word, on the next line if it does not fit.
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string_view word = text.substr(at, end - at);
    const std::size_t width = column_count(word);
    if (!first_of_line && used + 1 + width > columns) {
      result += '\n' + std::string(indent, ' ');
      used = indent;
    } else if (!first_of_line) {
      result += ' ';
      ++used;
    }
    result += word;
    used += width;
    first_of_line = false;
    at = end;
  }
  return result;
}

std::string two_columns(const std::vector<std::pair<std::string, std::string>>& rows, std::size_t columns,
                        std::size_t max_name_columns) {
  constexpr std::size_t margin = 2;
  // Only names that fit set the column: one long option would push all meanings to the right. Its own meaning begins
  // on the next line instead.
  std::size_t width = 0;
  for (const auto& [name, meaning] : rows)
    if (column_count(name) <= max_name_columns) width = std::max(width, column_count(name));
  const std::size_t column = margin + (width == 0 ? max_name_columns : width) + margin;
  std::string text;
  for (const auto& [name, meaning] : rows) {
    text += std::string(margin, ' ') + name;
    if (meaning.empty()) {
      text += '\n';
      continue;
    }
    const std::size_t used = margin + column_count(name);
    text += used + margin <= column ? std::string(column - used, ' ') : '\n' + std::string(column, ' ');
    text += wrapped(meaning, columns, column, column) + '\n';
  }
  return text;
}

}  // namespace sim
