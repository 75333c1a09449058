// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/diagnostics.hpp"

#include <mutex>
#include <set>
#include <utility>

#include "sim/config/message_text.hpp"

namespace sim {

namespace {

// Limit of lines: an error in a vehicle file is repeated for every vehicle of a fleet.
constexpr std::size_t max_lines = 1000;

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

/// Returns whether an error text does not quote the file: texts of the YAML parser except the one about anchors, and
/// those of load_config_file about a file that is not one of Shoal's.
bool is_free_of_quotes(const std::string& text) {
  if (text == "unknown key of a world or vehicle file" || text == "must be a map of keys and values") return true;
  return text.starts_with("not valid YAML: ") && text.find("anchor") == std::string::npos;
}

}  // namespace

std::string SourcePlace::text() const {
  if (file == nullptr) return "";
  if (line <= 0) return *file;
  return *file + ":" + std::to_string(line) + (column > 0 ? ":" + std::to_string(column) : "");
}

const std::string* intern_file_name(const std::string& file) {
  static std::mutex mutex;
  static std::set<std::string> names;  // elements of a set are never moved
  const std::lock_guard lock(mutex);
  return &*names.insert(file).first;
}

ConfigError::ConfigError(std::vector<std::string> lines)
    : std::runtime_error(joined(lines)), lines_(std::move(lines)) {}

void Diagnostics::error(const SourcePlace& place, const std::string& who, const std::string& text) {
  if (lines_.size() > max_lines) return;
  const bool hides = hides_files_ && place.origin == Origin::file && place.file != nullptr && !is_free_of_quotes(text);
  std::string line = place.text();
  for (const std::string& part : {subject_, who, text})
    if (!part.empty()) line += (line.empty() ? "" : ": ") + part;
  if (hides) {
    hidden_.push_back(printable(line));
    line = place.text() + ": is wrong; the file is not quoted, for the command line does not name it";
  }
  // Names are input: line feeds and escape sequences must not reach the terminal.
  line = printable(line);
  // Report an error in a vehicle file once, independent of the number of vehicles that use it.
  const std::string seen = printable(place.line > 0 && !hides ? place.text() + ": " + text : line);
  if (!seen_.insert(seen).second) return;
  if (lines_.size() == max_lines) line = "more errors are not shown";
  lines_.push_back(std::move(line));
}

void Diagnostics::throw_if_any() const {
  if (!ok()) throw ConfigError(lines_);
}

void throw_config_error(const SourcePlace& place, const std::string& who, const std::string& text) {
  Diagnostics diagnostics;
  diagnostics.error(place, who, text);
  throw ConfigError(diagnostics.lines());
}

}  // namespace sim
