// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <optional>
#include <string>
#include <utility>

namespace bridges {

/// File descriptor that is closed on destruction.
class FileDescriptor {
 public:
  explicit FileDescriptor(int number = -1) : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~FileDescriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }

 private:
  int number_;
};

/// Locks an open file or folder against other runs, for as long as the file stays open; the lock is released when the
/// process ends.  Returns std::nullopt on success, else the owner of the lock, such as `process 1234 (shoal run
/// world.yaml)`.
std::optional<std::string> lock_against_others(int file);

}  // namespace bridges
