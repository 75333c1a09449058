// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace sim {

class FileAccess;

/// Source of a value.
enum class Origin : unsigned char {
  file,          ///< a world, a vehicle file, or what they include
  command_line,  ///< `--set`
  bus            ///< a client on the bus
};

/// Place of a value: file (or `--set`), line and column counted from 1; line 0: the whole file.
struct SourcePlace {
  const std::string* file = nullptr;  ///< interned, valid until the program ends
  int line = 0;
  int column = 0;
  Origin origin = Origin::file;

  /// `worlds/harbor.yaml:14:7`, `worlds/harbor.yaml` or `--set vehicles.auv1.file`.
  std::string text() const;
};

/// Returns the shared copy of a file name, to which all places in the file refer.
const std::string* intern_file_name(const std::string& file);

/// Invalid input.  `lines()` holds all errors found, one line each; `what()` joins them.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(std::vector<std::string> lines);
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

/// Throws a ConfigError of one line in the format of Diagnostics.
[[noreturn]] void throw_config_error(const SourcePlace& place, const std::string& who, const std::string& text);

/// Collection of errors, so that all errors of a file are reported, not only the first.
class Diagnostics {
 public:
  Diagnostics() = default;
  /// `files`: the files that input read with these diagnostics may name; null: any.
  explicit Diagnostics(std::shared_ptr<const FileAccess> files) : files_(std::move(files)) {}
  /// `subject` precedes `who` in every error: `subject: who: text`.
  explicit Diagnostics(std::string subject) : subject_(std::move(subject)) {}

  /// Adds `place: who: text` (who may be empty).  The same text at the same place is stored once, independent of `who`.
  void error(const SourcePlace& place, const std::string& who, const std::string& text);
  bool ok() const { return lines_.empty(); }
  const std::vector<std::string>& lines() const { return lines_; }
  /// Throws ConfigError when there are errors.
  void throw_if_any() const;

  const std::shared_ptr<const FileAccess>& files() const { return files_; }
  /// Reduces errors in files to their places, because the recipient may not be entitled to see quoted content.  Errors
  /// in requests from the bus are unchanged.  The complete lines are in hidden().
  void hide_files() { hides_files_ = true; }
  const std::vector<std::string>& hidden() const { return hidden_; }

 private:
  std::shared_ptr<const FileAccess> files_;
  std::string subject_;
  bool hides_files_ = false;
  std::vector<std::string> hidden_;
  std::vector<std::string> lines_;
  std::set<std::string> seen_;
};

}  // namespace sim
