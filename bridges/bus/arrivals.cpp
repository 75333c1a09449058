// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/arrivals.hpp"

#include <algorithm>

namespace bridges {

Arrivals::Arrivals() {
  readable_.add(wake_.fd(), nullptr);
}

void Arrivals::add(Port& port, int fd) {
  if (fd >= 0) readable_.add(fd, &port);
  ports_.push_back({&port, fd});
}

void Arrivals::remove(Port& port) {
  const auto watched =
      std::find_if(ports_.begin(), ports_.end(), [&](const Watched& each) { return each.port == &port; });
  if (watched == ports_.end()) return;
  if (watched->fd >= 0) readable_.remove(watched->fd);
  ports_.erase(watched);
}

void Arrivals::arrived() {
  count_.fetch_add(1);
  // A thread that falls asleep now reads the new count.
  if (!asleep_.load() || !asleep_.exchange(false)) return;
  wake_.set();
}

bool Arrivals::wait(std::chrono::milliseconds timeout) {
  using std::chrono::steady_clock;
  const auto deadline = steady_clock::now() + timeout;
  // Nothing may stay queued while this thread sleeps: the client that is awaited may be waiting for it.
  for (const Watched& each : ports_) each.port->send_queued();
  for (std::chrono::milliseconds left = timeout;;) {
    // The flag is set before the count is read, and publishers read it after they count: a message that comes in
    // between wakes the wait.
    asleep_ = true;
    const bool came = count_.load() != seen_;
    const PollSet::Readable readable = came ? PollSet::Readable{} : readable_.wait(left);
    asleep_ = false;
    if (came) break;
    receive(readable);
    if (count_.load() != seen_) break;
    if (left.count() == 0 && readable.count == 0) return false;
    left = std::max(std::chrono::ceil<std::chrono::milliseconds>(deadline - steady_clock::now()), left * 0);
  }
  seen_ = count_.load();
  return true;
}

void Arrivals::receive(const PollSet::Readable& readable) {
  for (std::size_t i = 0; i < readable.count; ++i) {
    if (readable.tags[i] == nullptr) {
      wake_.clear();
    } else if (Port& port = *static_cast<Port*>(readable.tags[i]); !port.receive()) {
      remove(port);
    }
  }
}

}  // namespace bridges
