// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace sim {

/// Which files a world may name.  A world may be untrusted: the files that it names must lie below a few folders,
/// unless the user allows others.  Symbolic links count by what they lead to.
class FileAccess {
 public:
  /// `folders`: what lies below them may be read.  `allowed`: folders and files that the command line names: they may
  /// be read, serial ports may be made below them, and they are quoted in errors.  `known_keys`: those of the top level
  /// of a world or vehicle file; see may_quote().
  FileAccess(std::vector<std::string> folders, std::vector<std::string> allowed, std::set<std::string> known_keys);

  /// No serial port is opened: their paths do not matter.
  void ignore_ports() { ignores_ports_ = true; }

  bool may_read(const std::string& path) const;
  /// A serial port: a relative path without `..`, which is made below the folder of the run, or one below what the
  /// command line names.
  bool may_make(const std::string& path) const;
  /// Of what the command line names, what `path` lies below; empty: nothing.
  std::string allowed_above(const std::string& path) const;
  /// Whether errors may quote a file that a world names: one that the command line names too.
  bool may_quote(const std::string& path) const;
  bool is_known_key(const std::string& key) const { return known_keys_.contains(key); }

  /// What to say of a path that may_read() refuses.
  static std::string reading_rule();
  /// The same of may_make().
  static std::string making_rule();

 private:
  std::vector<std::filesystem::path> folders_, allowed_;
  std::set<std::string> known_keys_;
  bool ignores_ports_ = false;
};

/// Null: any file.
using FileAccessPointer = std::shared_ptr<const FileAccess>;

}  // namespace sim
