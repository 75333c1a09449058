// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sim {

/// Returns the columns of text on a file descriptor: COLUMNS when it is a whole number, else the width of the terminal,
/// else 80.  From 40 to 1000.
int text_columns(int file_descriptor);

/// Returns true for a terminal that executes escape codes: not for a pipe, and not with TERM=dumb.
bool can_move_cursor(int file_descriptor);

/// Returns true when escape codes for colors may be written: as above, and NO_COLOR is unset or empty.
bool may_use_color(int file_descriptor);

/// Returns the number of characters of UTF-8 text; every character counts as one column.
std::size_t column_count(std::string_view text);

/// Returns the first `columns` characters; a shortened text ends in `...`.
std::string cut_to(std::string_view text, std::size_t columns);

/// Fills lines of at most `columns` characters with the words of a text.  Lines after the first are indented by
/// `indent` spaces; `starts_at` is the number of characters already on the first line.  A word that is longer than a
/// line gets its own line, unbroken.  No newline at the end.
std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent = 0, std::size_t starts_at = 0);

/// Lays out names and their wrapped descriptions in two columns.  The description of a name that is too long starts on
/// the next line.
std::string two_columns(const std::vector<std::pair<std::string, std::string>>& rows, std::size_t columns,
                        std::size_t max_name_columns = 24);

}  // namespace sim
