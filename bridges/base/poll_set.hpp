// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>

namespace bridges {

/// Waits for file descriptors.  When several sets hold the same descriptor, only one wakes: of the waiting ones, the
/// one that has held it longest.
class PollSet {
 public:
  /// Throws BusError when no file descriptor is left.
  PollSet();
  ~PollSet();
  PollSet(const PollSet&) = delete;
  PollSet& operator=(const PollSet&) = delete;

  static constexpr std::size_t max_at_once = 16;
  struct Readable {
    std::array<void*, max_at_once> tags;
    std::size_t count = 0;
  };

  /// `tag` comes back from wait().  Throws BusError.
  void add(int fd, void* tag);
  void remove(int fd);
  /// Those that can be read; none on time-out or signal.  Negative: no time-out.
  Readable wait(std::chrono::milliseconds timeout);

 private:
  int epoll_;
};

}  // namespace bridges
