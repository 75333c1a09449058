// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/log.hpp"

#include <spdlog/spdlog.h>

namespace sim {
namespace {

spdlog::level::level_enum level_of_spdlog(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return spdlog::level::debug;
    case LogLevel::info:
      return spdlog::level::info;
    case LogLevel::warn:
      return spdlog::level::warn;
    case LogLevel::error:
      break;
  }
  return spdlog::level::err;
}

}  // namespace

void set_log_level(const std::string& name) {
  spdlog::set_level(spdlog::level::from_str(name));
}

bool log_shows(LogLevel level) {
  return spdlog::should_log(level_of_spdlog(level));
}

void write_log(LogLevel level, fmt::string_view text, fmt::format_args values) {
  if (log_shows(level)) spdlog::log(level_of_spdlog(level), fmt::vformat(text, values));
}

}  // namespace sim
