// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bridges/base/file_descriptor.hpp"

namespace tools {

/// Before a file is written: an existing link in its place would lead elsewhere.  Other files stay,
/// and links to terminals and the like.
void remove_link(const std::string& path);

/// summary.json of a run, with room on the disk for it from the start: a disk that is full by the end must not cost
/// score and hash.  The room is in `summary.json.part` and `.part2` beside it, for the summary can be written twice.
class SummaryFile {
 public:
  /// Throws std::runtime_error with path and reason when there is no room.
  SummaryFile(const std::string& directory, std::size_t bytes);
  ~SummaryFile();
  SummaryFile(const SummaryFile&) = delete;
  SummaryFile& operator=(const SummaryFile&) = delete;

  /// A reader finds it whole or not at all.  Throws std::runtime_error.
  void write(const std::string& text);

 private:
  struct Room {
    std::string path;
    bridges::FileDescriptor file;
  };
  void make_room(const std::string& path, std::size_t bytes);

  std::string path_;
  std::vector<Room> rooms_;
};

}  // namespace tools
