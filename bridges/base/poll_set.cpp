// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/base/poll_set.hpp"

#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <string>

#include "bridges/base/bus_error.hpp"

namespace bridges {

PollSet::PollSet() : epoll_(epoll_create1(EPOLL_CLOEXEC)) {
  if (epoll_ < 0) throw BusError(std::string("the bus needs epoll: epoll_create1: ") + std::strerror(errno));
}

PollSet::~PollSet() {
  close(epoll_);
}

void PollSet::add(int fd, void* tag) {
  epoll_event event{};
  event.events = EPOLLIN | EPOLLEXCLUSIVE;
  event.data.ptr = tag;
  if (epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event) != 0)
    throw BusError(std::string("cannot watch a socket of the bus: epoll_ctl: ") + std::strerror(errno));
}

void PollSet::remove(int fd) {
  epoll_ctl(epoll_, EPOLL_CTL_DEL, fd, nullptr);
}

PollSet::Readable PollSet::wait(std::chrono::milliseconds timeout) {
  std::array<epoll_event, max_at_once> events;
  const auto limit = std::clamp<std::int64_t>(timeout.count(), -1, std::numeric_limits<int>::max());
  const int count = epoll_wait(epoll_, events.data(), max_at_once, static_cast<int>(limit));
  Readable readable;
  for (int i = 0; i < count; ++i) readable.tags[readable.count++] = events[static_cast<std::size_t>(i)].data.ptr;
  return readable;
}

}  // namespace bridges
