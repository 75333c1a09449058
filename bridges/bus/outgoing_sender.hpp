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

/// Sends messages in the order in which they were pushed: in its own thread, or in that of a caller that is about to
/// wait for the answer, which saves the time for waking the thread.
class OutgoingSender {
 public:
  /// Called by one thread at a time.  May block; then it holds up the caller of help() once.
  using Send = std::function<void(const OutgoingQueue::Entry& message)>;

  OutgoingSender(const OutgoingQueue::Limits& limits, Send send);
  ~OutgoingSender();
  /// Sends what is queued, for at most `time_to_flush`; then `unblock` is called, which makes Send return.
  void close(const std::function<void()>& unblock);

  void push(std::string_view channel, std::span<const std::byte> payload) { queue_.push(channel, payload); }
  /// Starts the thread.
  void wake() { queue_.wake(); }
  /// Sends what is queued, unless the thread is at it.  After `max_help` the thread does the rest, and all there is
  /// for the next `time_out_of_help`.  By one thread.
  void help();
  /// Until everything pushed so far is sent or dropped.  False on time-out.
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
