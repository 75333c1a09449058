// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace sim {

/// Rules for the files that a world may name.  A world may be untrusted: its files must lie below given folders, unless
/// the user allows others.  Symbolic links are resolved first.
class FileAccess {
 public:
  /// `folders`: files below them may be read.  `allowed`: folders and files that the command line names: they may be
  /// read, serial ports may be created below them, and errors may quote them.  `known_keys`: keys of the top level of a
  /// world or vehicle file; see may_quote().
  FileAccess(std::vector<std::string> folders, std::vector<std::string> allowed, std::set<std::string> known_keys);

  /// Accepts any path of a serial port, because none is opened.
  void ignore_ports() { ignores_ports_ = true; }

  bool may_read(const std::string& path) const;
  /// Returns whether a serial port may be created: a relative path without `..`, below the folder of the run, or a path
  /// below a folder that the command line names.
  bool may_make(const std::string& path) const;
  /// Returns the folder named by the command line that contains `path`; empty: none.
  std::string allowed_above(const std::string& path) const;
  /// Returns whether errors may quote a file that a world names: only when the command line names it too.
  bool may_quote(const std::string& path) const;
  bool is_known_key(const std::string& key) const { return known_keys_.contains(key); }

  /// Text of the rule of may_read(), for error messages.
  static std::string reading_rule();
  /// Text of the rule of may_make(), for error messages.
  static std::string making_rule();

 private:
  std::vector<std::filesystem::path> folders_, allowed_;
  std::set<std::string> known_keys_;
  bool ignores_ports_ = false;
};

/// Shared rules; null: any file.
using FileAccessPointer = std::shared_ptr<const FileAccess>;

/// Returns the folder with the `worlds/` and `vehicles/` shipped with this program: `share/shoal` of its installation,
/// or the checkout of its build folder; in a library that another program has loaded, those of the library.  Empty:
/// there is none.
std::string shipped_folder();

/// Returns the folder of this program, where others of its installation or build are; in a library that another program
/// has loaded, such as the module of Python: `bin` above the library, if `shoal` is there.  Empty: there is none.
std::string program_folder();

/// Returns the folder with `worlds/` and `vehicles/` for a program in `folder`, such as `/usr/local/bin` or
/// `checkout/build/release/bin`.
std::string shipped_folder_of(const std::string& folder);

}  // namespace sim
