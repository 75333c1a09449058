// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/json_reader.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "bridges/base/json_text.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

using Json = nlohmann::ordered_json;

std::string shown_json(const Json& value) {
  return sim::shortened(sim::printable(bridges::json_text(value)));
}

Json parse_json(const std::string& text, const std::string& file) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    // `byte` counts from 1, and is the last byte that was read.
    const std::size_t at = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
    const std::size_t begin = text.rfind('\n', at > 0 ? at - 1 : 0);
    const std::size_t line_begin = begin == std::string::npos || begin >= at ? 0 : begin + 1;
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(line_begin), '\n');
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string rest = text.substr(at, end - at);
    throw std::runtime_error(fmt::format("{}:{}:{}: must be JSON, got {}", file, line, at - line_begin + 1,
                                         at == text.size() ? "the end of the file"
                                         : rest.empty()    ? "the end of the line"
                                                           : "'" + sim::shortened(sim::printable(rest), 30) + "'"));
  } catch (const Json::exception&) {
    throw std::runtime_error(file + ": must be JSON with numbers of at most 1.8e308");
  }
}

}  // namespace experiment
