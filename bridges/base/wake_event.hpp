// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/eventfd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>

#include "bridges/base/bus_error.hpp"
#include "bridges/base/file_descriptor.hpp"

namespace bridges {

/// Wakes a thread that waits for descriptors: readable from set() until clear().
class WakeEvent {
 public:
  /// Throws BusError when no file descriptor is available.
  WakeEvent() : event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (event_.number() < 0) throw BusError(std::string("no file descriptor: ") + std::strerror(errno));
  }
  int fd() const { return event_.number(); }
  void set() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(fd(), &one, sizeof one);  // fails only when it is set already
  }
  void clear() const {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t read = ::read(fd(), &count, sizeof count);
  }

 private:
  const FileDescriptor event_;
};

}  // namespace bridges
