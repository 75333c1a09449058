// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/lcm/lcm_connection.hpp"
#include "bridges/lcm/udp_receiver.hpp"

namespace bridges {

/// What one udpm connection receives, by channel.  When many messages without a subscription arrive, the kernel drops
/// them (channel_filter): on a bus, messages for others and echoes of one's own outnumber the subscribed ones.
class UdpInbox {
 public:
  using Handler = LcmConnection::Handler;
  struct Subscription {
    std::string channel;  ///< empty: all
    Handler handler = nullptr;
    void* user = nullptr;
  };

  /// Throws BusError; its text says what failed, without the URL.
  explicit UdpInbox(const UdpReceiver::Options& options) : receiver_(options) {}

  int fd() const { return receiver_.fd(); }
  /// From any thread.  remove() identifies it by the address of `subscription`.
  void add(const Subscription& subscription);
  void remove(const Subscription& subscription);
  /// Calls the handlers for one batch.  By one thread at a time.  True when there may be more.
  bool handle();

  struct Counts {
    std::uint64_t datagrams = 0;  ///< that the kernel let pass
    std::uint64_t foreign = 0;    ///< of other machines, dropped
    std::uint64_t bad = 0;        ///< not LCM's, or breaking its format
    std::uint64_t unmatched = 0;  ///< messages on channels without subscription
  };
  /// By the thread that handles.
  Counts counts() const;
  bool filters() const { return filtering_; }
  /// Of all datagrams so far.  From any thread.
  std::uint64_t received_bytes() const { return received_bytes_; }

 private:
  using Clock = std::chrono::steady_clock;

  struct Call {
    const Subscription* of;
    Handler handler;
    void* user;
  };
  bool accepts(std::string_view channel) const;
  void deliver(const LcmReassembly::Message& message, std::int64_t received_at_us);
  void filter_if_worthwhile();
  void subscriptions_changed();

  UdpReceiver receiver_;
  mutable std::mutex mutex_;  // of the subscriptions and the filter
  std::map<std::string, std::vector<Call>, std::less<>> by_channel_;
  std::vector<Call> to_all_;
  bool filtering_ = false;
  bool filter_refused_ = false;  // for these subscriptions
  Clock::time_point changed_at_;
  std::atomic<std::uint64_t> received_bytes_ = 0;
  std::vector<Call> called_;  // by the thread that handles
  std::uint64_t unmatched_ = 0, unmatched_before_ = 0;
};

}  // namespace bridges
