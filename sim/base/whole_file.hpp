// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace sim {

/// Returns all bytes of a regular file of at most `max_mb` megabytes.  Throws Error with the reason, without the name
/// of the file.
template <typename Error>
std::string whole_file(const std::string& path, std::uintmax_t max_mb = 1000) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw Error("does not exist");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > max_mb * 1'000'000)
    throw Error("is larger than " +
                (max_mb < 1000 ? std::to_string(max_mb) + " MB" : std::to_string(max_mb / 1000) + " GB"));
  std::string bytes(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size))) throw Error("cannot be read");
  return bytes;
}

}  // namespace sim
