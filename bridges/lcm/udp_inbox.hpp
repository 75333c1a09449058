// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <linux/filter.h>

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

/// Receiver of one udpm connection that dispatches messages by channel.  When many messages without a subscription
/// arrive, a kernel filter drops them (channel_filter): on a bus, messages for other programs and echoes of own
/// messages outnumber the subscribed ones.
class UdpInbox {
 public:
  using Handler = LcmConnection::Handler;
  struct Subscription {
    std::string channel;  ///< empty: all
    Handler handler = nullptr;
    void* user = nullptr;
  };

  /// Throws BusError with the operation that failed, without the URL.
  explicit UdpInbox(const UdpReceiver::Options& options) : receiver_(options) {}

  int fd() const { return receiver_.fd(); }
  /// Adds a subscription.  Thread-safe.  remove() identifies it by the address of `subscription`.
  void add(const Subscription& subscription);
  void remove(const Subscription& subscription);
  /// Calls the handlers for one batch.  By one thread at a time.  Returns true when there may be more.
  bool handle();

  struct Counts {
    std::uint64_t datagrams = 0;  ///< datagrams passed by the kernel filter
    std::uint64_t foreign = 0;    ///< dropped datagrams from other machines
    std::uint64_t bad = 0;        ///< datagrams that are not LCM, or violate its format
    std::uint64_t unmatched = 0;  ///< messages on channels without subscription
  };
  /// Returns the counts; only for the handling thread.
  Counts counts() const;
  bool filters() const { return filtering_; }
  /// Returns the bytes of all datagrams received.  Thread-safe.
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
  mutable std::mutex mutex_;  // protects the subscriptions and the filter
  std::map<std::string, std::vector<Call>, std::less<>> by_channel_;
  std::vector<Call> to_all_;
  bool filtering_ = false;
  bool filter_refused_ = false;  // for these subscriptions
  Clock::time_point changed_at_;
  std::atomic<std::uint64_t> received_bytes_ = 0;
  std::vector<Call> called_;  // used by the handling thread only
  std::uint64_t unmatched_ = 0, unmatched_before_ = 0;
};

/// Returns a socket filter (classic BPF, for a UDP socket) that passes the datagrams a receiver of these channels may
/// need: messages on them, fragments that do not name their channel, and datagrams that are too short to classify.  It
/// compares a hash of the first 16 bytes of the channel, so that a few other messages also pass; it never drops a
/// message on these channels.  Empty when there are too many channels for one program.
std::vector<sock_filter> channel_filter(const std::vector<std::string>& channels);

}  // namespace bridges
