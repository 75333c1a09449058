#pragma once

#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace sim {

/// Where a value was written: a file (or `--set`), a line and a column counted from 1; line 0: the whole file.
struct SourcePlace {
  const std::string* file = nullptr;  ///< interned, lives as long as the program
  int line = 0;
  int column = 0;

  /// `worlds/harbor.yaml:14:7`, `worlds/harbor.yaml` or `--set vehicles.auv1.file`.
  std::string text() const;
};

/// One copy of a file name for all the places in it.
const std::string* intern_file_name(const std::string& file);

/// Bad input.  `lines()` holds every error found, one line each; `what()` joins them.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(std::vector<std::string> lines);
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

/// Throws ConfigError of one line, as Diagnostics would write it.
[[noreturn]] void throw_config_error(const SourcePlace& place, const std::string& who, const std::string& text);

/// Collects errors so that all errors of a file are reported, not only the first.
class Diagnostics {
 public:
  /// Adds `place: who: text` (who may be empty).  The same text at the same place is kept once, whoever it is about.
  void error(const SourcePlace& place, const std::string& who, const std::string& text);
  bool ok() const { return lines_.empty(); }
  const std::vector<std::string>& lines() const { return lines_; }
  /// Throws ConfigError when there are errors.
  void throw_if_any() const;

 private:
  std::vector<std::string> lines_;
  std::set<std::string> seen_;
};

}  // namespace sim
