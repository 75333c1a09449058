// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "experiment/files/part_file.hpp"

struct archive;

namespace experiment {

/// Writer of a tar file, compressed by gzip.  The file appears under its name only when it is complete.
class TarFile {
 public:
  /// Throws std::runtime_error with path and reason, like all functions here.
  explicit TarFile(const std::string& path);
  /// Removes an unfinished file.
  ~TarFile();
  TarFile(const TarFile&) = delete;
  TarFile& operator=(const TarFile&) = delete;

  void add(const std::string& name, const std::string& bytes);
  /// Adds the content of a file.
  void add_file(const std::string& name, const std::string& path);
  /// Closes the archive and renames it to its final name.
  void finish();

 private:
  void start_entry(const std::string& name, std::uint64_t size);
  void write(const char* bytes, std::size_t size);
  [[noreturn]] void fail() const;

  PartFile<> file_;
  archive* archive_;
};

}  // namespace experiment
