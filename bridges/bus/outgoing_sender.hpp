// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <thread>

#include "bridges/bus/outgoing_queue.hpp"

namespace bridges {

/// Sender of messages in the order in which they were pushed: in its own thread, or in that of a caller that then waits
/// for an answer, which saves the time to wake the thread.
class OutgoingSender {
 public:
  /// Function that sends a message.  Called by one thread at a time.  May block, which delays the caller of help()
  /// once.
  using Send = std::function<void(const OutgoingQueue::Entry& message)>;

  OutgoingSender(const OutgoingQueue::Limits& limits, Send send);
  ~OutgoingSender();
  /// Sends the queued messages, for at most `time_to_flush`; then calls `unblock`, which makes Send return.
  void close(const std::function<void()>& unblock);

  void push(std::string_view channel, std::span<const std::byte> payload) { queue_.push(channel, payload); }
  /// Starts the thread.
  void wake() { queue_.wake(); }
  /// Sends the queued messages in the calling thread, unless the sender thread is active.  After `max_help` the sender
  /// thread continues, and sends all messages during the next `time_out_of_help`.  For one thread.
  void help();
  /// Waits until everything pushed so far is sent or dropped.  Returns false on time-out.
  bool wait_until_sent(std::chrono::milliseconds timeout) { return queue_.wait_until_sent(timeout); }
  std::uint64_t dropped() const { return queue_.dropped(); }

  static constexpr std::chrono::milliseconds max_help{5}, time_out_of_help{1000}, time_to_flush{1000};

 private:
  using Clock = std::chrono::steady_clock;
  void run();

  Send send_;
  OutgoingQueue queue_;
  Clock::time_point help_from_;
  std::thread thread_;
};

}  // namespace bridges
