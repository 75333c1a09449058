// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bridges {

/// Queue of messages for the network, between the simulating and the sending thread.  Bounded: the oldest messages are
/// dropped and counted.  The lock is held only to move a message; bytes are copied outside of it.
class OutgoingQueue {
 public:
  struct Entry {
    std::string channel;
    std::vector<std::byte> payload;
  };
  struct Limits {
    std::size_t messages = 20'000;
    std::size_t bytes = std::size_t{64} << 20;
    std::size_t wake_at = 256;  ///< number of queued messages that wakes the sender before the end of the step
  };

  explicit OutgoingQueue(const Limits& limits) : limits_(limits) {}

  void push(std::string_view channel, std::span<const std::byte> payload);
  /// Wakes the sender.
  void wake();
  /// Waits for and returns the oldest message, for the sender.  `used`: the message sent before, whose memory is
  /// reused.  Returns null when the queue is closed and either empty or past its deadline.
  std::unique_ptr<Entry> next(std::unique_ptr<Entry> used);
  /// Returns the oldest message for another thread, without waiting and without a call of wake().  Returns null when
  /// there is none, or while the sender is active, which also sends everything pushed before this call.
  std::unique_ptr<Entry> next_if_idle(std::unique_ptr<Entry> used);
  /// Leaves the remaining messages to the sender; called by the other thread.
  void hand_over(std::unique_ptr<Entry> used);
  /// Closes the queue; queued messages may be sent until the deadline.
  void close(std::chrono::steady_clock::time_point deadline);
  /// Waits until everything pushed so far is sent or dropped.  Returns false on time-out.
  bool wait_until_sent(std::chrono::milliseconds timeout);
  std::uint64_t dropped() const;

 private:
  std::unique_ptr<Entry> free_entry();
  void recycle(std::unique_ptr<Entry> entry);
  void finish(std::unique_ptr<Entry> used);
  std::unique_ptr<Entry> take_first();

  const Limits limits_;
  mutable std::mutex mutex_;
  std::condition_variable sender_;
  std::condition_variable sent_;
  std::deque<std::unique_ptr<Entry>> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::vector<std::unique_ptr<Entry>> free_;
  std::size_t free_bytes_ = 0;
  std::uint64_t dropped_ = 0;
  bool sending_ = false;  // a thread holds a message that is not sent yet
  bool sender_waits_ = false;
  bool awake_ = false;  // requested to send all pending messages
  bool closed_ = false;
  std::chrono::steady_clock::time_point deadline_;
};

}  // namespace bridges
