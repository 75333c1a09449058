// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/lcm_listener.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>

namespace bridges {
namespace {

using namespace std::chrono_literals;

// Self test that every LCM program publishes at its start.
/// Limit of one receive call of the background thread, after which the waiting thread can continue.
constexpr int max_batches = 64;
constexpr std::size_t message_overhead_bytes = sizeof(Received) + 64;

void raise(const FileDescriptor& event) {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(event.number(), &one, sizeof one);
}

}  // namespace

LcmListener::LcmListener(const std::string& url)
    : connection_(url), wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)), stop_(eventfd(0, EFD_CLOEXEC)) {
  if (wake_.number() < 0 || stop_.number() < 0) throw BusError("no file descriptor is available for the bus");
  // Added before the thread: the first of the two wakes.
  readable_.add(connection_.fd(), &connection_);
  readable_.add(wake_.number(), nullptr);
  if (lcm_endpoint(connection_.url()).kind != "udpm") return;
  readable_by_thread_.add(connection_.fd(), &connection_);
  readable_by_thread_.add(stop_.number(), nullptr);
  thread_ = std::thread([this] { receive_in_background(); });
}

LcmListener::~LcmListener() {
  raise(stop_);
  if (thread_.joinable()) thread_.join();
}

void LcmListener::keep(const LcmMessage& message, void* listener) {
  if (message.channel == std::string_view(self_test_channel)) return;
  auto& self = *static_cast<LcmListener*>(listener);
  Received received{std::string(message.channel), {message.payload.begin(), message.payload.end()}, message.wall_utime};
  bool waiting = false;
  {
    const std::lock_guard lock(self.mutex_);
    self.arrived_bytes_ += received.payload.size() + message_overhead_bytes;
    self.arrived_.push_back(std::move(received));
    // The newest message stays in any case, however large.
    while (self.arrived_bytes_ > max_waiting_bytes && self.arrived_.size() > 1) {
      self.arrived_bytes_ -= self.arrived_.front().payload.size() + message_overhead_bytes;
      self.arrived_.pop_front();
    }
    waiting = std::exchange(self.waiting_, false);
  }
  if (waiting) raise(self.wake_);
}

void LcmListener::listen(const std::string& channel) {
  connection_.subscribe(channel, keep, this);
}

void LcmListener::listen_to_all() {
  connection_.subscribe_to_all(keep, this);
}

void LcmListener::take_in_batches(std::function<void()> before_wait) {
  raise(stop_);
  if (thread_.joinable()) thread_.join();
  before_wait_ = std::move(before_wait);
}

std::optional<Received> LcmListener::take() {
  const std::lock_guard lock(mutex_);
  waiting_ = arrived_.empty();
  if (arrived_.empty()) return std::nullopt;
  Received message = std::move(arrived_.front());
  arrived_.pop_front();
  arrived_bytes_ -= message.payload.size() + message_overhead_bytes;
  return message;
}

std::optional<Received> LcmListener::next(std::chrono::milliseconds timeout) {
  using std::chrono::steady_clock;
  const auto deadline = steady_clock::now() + timeout;
  std::chrono::milliseconds left = timeout;
  while (true) {
    if (auto message = take()) return message;
    if (before_wait_) before_wait_();
    // Wait for the network or the background thread.
    const PollSet::Readable readable = readable_.wait(left);
    if (readable.count == 0) break;
    for (std::size_t i = 0; i < readable.count; ++i) {
      // Clear the wake-up, or receive from the network.
      if (readable.tags[i] == nullptr) {
        std::uint64_t times = 0;
        [[maybe_unused]] const auto got = read(wake_.number(), &times, sizeof times);
      } else {
        {
          const std::lock_guard lock(mutex_);
          waiting_ = false;  // this thread is awake
        }
        receive();
      }
    }
    left = std::max(std::chrono::ceil<std::chrono::milliseconds>(deadline - steady_clock::now()), left * 0);
  }
  auto message = take();
  const std::lock_guard lock(mutex_);
  waiting_ = false;
  return message;
}

void LcmListener::receive() {
  const std::lock_guard lock(receive_mutex_);
  if (connection_.handle() == LcmConnection::Handled::lost) throw BusError("the connection to " + url() + " is lost");
}

void LcmListener::receive_in_background() {
  const auto stopped = [](const PollSet::Readable& readable) {
    return std::any_of(readable.tags.begin(), readable.tags.begin() + readable.count,
                       [](const void* tag) { return tag == nullptr; });
  };
  GatherPauses pauses(connection_);
  while (true) {
    const PollSet::Readable readable = readable_by_thread_.wait(pauses.wait());
    if (stopped(readable)) return;
    if (readable.count > 0) {
      const std::lock_guard lock(receive_mutex_);
      // A bound on the work under the lock, so that readers of the queue get their turn.
      for (int i = 0; i < max_batches && connection_.handle() == LcmConnection::Handled::more; ++i) {
      }
    }
    if (pauses.due(readable.count > 0) && wait_readable(stop_.number(), -1, GatherPauses::length)) return;
  }
}

bool LcmListener::publish(std::string_view channel, std::span<const std::byte> payload) {
  if (channel.empty() || channel.size() > sim::Bus::max_channel_length || payload.size() > max_lcm_message_bytes)
    return false;
  return connection_.publish(std::string(channel).c_str(), payload);
}

}  // namespace bridges
