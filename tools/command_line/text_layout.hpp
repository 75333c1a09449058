// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace command_line {

/// Columns for text on a file descriptor: COLUMNS when it is a whole number, else the width of the terminal, else 80.
/// From 40 to 1000.
int text_columns(int file_descriptor);

/// True of a terminal that executes escape codes: not in a pipe, and not with TERM=dumb.
bool can_move_cursor(int file_descriptor);

/// True when escape codes for colours may be written: the same, and NO_COLOR is unset or empty.
bool may_use_colour(int file_descriptor);

/// Characters of UTF-8 text; every character counts as one column.
std::size_t column_count(std::string_view text);

/// The first `columns` characters; a text that is cut ends in `...`.
std::string cut_to(std::string_view text, std::size_t columns);

/// Fills lines of at most `columns` characters with the words of a text.  Lines after the first are indented by
/// `indent` spaces; `starts_at` is the number of characters already on the first line.  A word that is longer than a
/// line gets its own line, uncut.  No newline at the end.
std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent = 0, std::size_t starts_at = 0);

/// Two columns: names, and beside them what they mean, wrapped.  A name that is too long has its meaning below.
std::string two_columns(const std::vector<std::pair<std::string, std::string>>& rows, std::size_t columns,
                        std::size_t max_name_columns = 24);

}  // namespace command_line
