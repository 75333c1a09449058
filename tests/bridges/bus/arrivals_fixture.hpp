// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/eventfd.h>
#include <unistd.h>

#include <chrono>

namespace arrivals_fixture {

using namespace bridges;
using namespace std::chrono_literals;

/// A descriptor that becomes readable when someone calls ring().
class Bell {
 public:
  Bell() : fd_(eventfd(0, EFD_NONBLOCK)) {}
  ~Bell() { close(fd_); }
  int fd() const { return fd_; }
  void ring() { eventfd_write(fd_, 1); }
  bool answer() {
    eventfd_t times = 0;
    return eventfd_read(fd_, &times) == 0;
  }

 private:
  int fd_;
};

}  // namespace arrivals_fixture
