// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tools {

/// Kind of a file.
enum class FileKind { world, vehicle, study };

/// Path to a node from the root of a world, vehicle or study: keys, and `*` for items of lists.  It uses the present
/// format, also for files in an older one, and is independent of where the node is written: `overrides:
/// {devices.lidar.rate_hz: 0}` of a world leads to `devices.lidar.rate_hz` of a vehicle, and the keys of an action lead
/// to `events.*.do.*.WORD.KEY`, also in the lists of `one_of`.
class KeyPath {
 public:
  explicit KeyPath(FileKind kind) : kind_(kind) {}

  FileKind kind() const { return kind_; }
  const std::vector<std::string>& keys() const { return keys_; }
  /// Returns whether the path matches `pattern`, keys separated by dots; `*` matches any key or item, the empty pattern
  /// the root.
  bool is(FileKind kind, std::string_view pattern) const;

  /// Returns the path of an item of the list here.
  KeyPath item() const;
  /// Returns the path of the value of a key of the map here.  The key may be a dotted path where the format allows
  /// that.
  KeyPath value_of(std::string_view key) const;
  /// Returns the same where the map is an action in the form of version 0.1, and `word` the key that names it.
  KeyPath value_of_action(std::string_view key, std::string_view word) const;

  /// Returns whether the keys of the map here are dotted paths.
  bool has_dotted_keys() const;
  /// Returns the path that the first part of a dotted key starts from.
  KeyPath top_of_dotted() const;
  /// Returns whether the map here is an action of an event.
  bool is_action() const;

 private:
  void add(std::string_view key);

  FileKind kind_;
  std::vector<std::string> keys_;
};

}  // namespace tools
