// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

struct archive;

namespace tools {

/// Writes a tar file, compressed by gzip.  A reader finds it whole or not at all.
class TarFile {
 public:
  /// Throws std::runtime_error with path and reason, as all functions here.
  explicit TarFile(const std::string& path);
  /// What was not finished is removed.
  ~TarFile();
  TarFile(const TarFile&) = delete;
  TarFile& operator=(const TarFile&) = delete;

  void add(const std::string& name, const std::string& bytes);
  /// The bytes of a file.
  void add_file(const std::string& name, const std::string& path);
  /// Closes it and gives it its name.
  void finish();

 private:
  void start_entry(const std::string& name, std::uint64_t size);
  void write(const char* bytes, std::size_t size);
  [[noreturn]] void fail() const;

  std::string path_, part_;
  archive* archive_;
};

}  // namespace tools
