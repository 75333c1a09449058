// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>

namespace bridges {

/// Set of file descriptors to wait for.  When several sets hold the same descriptor, only one wakes: the waiting set
/// that has held it longest.
class PollSet {
 public:
  /// Throws BusError when no file descriptor is available.
  PollSet();
  ~PollSet();
  PollSet(const PollSet&) = delete;
  PollSet& operator=(const PollSet&) = delete;

  static constexpr std::size_t max_at_once = 16;
  struct Readable {
    std::array<void*, max_at_once> tags;
    std::size_t count = 0;
  };

  /// Adds a descriptor.  `tag`: returned by wait().  Throws BusError.
  void add(int fd, void* tag);
  void remove(int fd);
  /// Waits for readable descriptors and returns them; none on time-out or signal.  Negative timeout: unlimited.
  Readable wait(std::chrono::milliseconds timeout);

 private:
  int epoll_;
};

}  // namespace bridges
