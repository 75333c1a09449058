// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/core.h>

#include <string>

namespace sim {

// Messages for the user, on stderr.  They are formatted in the library of fmt: spdlog formats in its headers, which is
// 40 kB of code, and a second of compilation, in each object that logs.

enum class LogLevel { debug, info, warn, error };

/// Shows messages from this level on: `debug`, `info`, `warn`, `error`, or `off` for none.
void set_log_level(const std::string& name);
/// Whether messages of this level are shown.
bool log_shows(LogLevel level);

void write_log(LogLevel level, fmt::string_view text, fmt::format_args values);

template <typename... Values>
void log_debug(fmt::format_string<Values...> text, Values&&... values) {
  write_log(LogLevel::debug, text, fmt::make_format_args(values...));
}

template <typename... Values>
void log_info(fmt::format_string<Values...> text, Values&&... values) {
  write_log(LogLevel::info, text, fmt::make_format_args(values...));
}

template <typename... Values>
void log_warn(fmt::format_string<Values...> text, Values&&... values) {
  write_log(LogLevel::warn, text, fmt::make_format_args(values...));
}

template <typename... Values>
void log_error(fmt::format_string<Values...> text, Values&&... values) {
  write_log(LogLevel::error, text, fmt::make_format_args(values...));
}

}  // namespace sim
