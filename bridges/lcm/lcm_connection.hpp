// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bridges/base/bus_error.hpp"
#include "bridges/lcm/lcm_url.hpp"

// Type of liblcm, declared here to avoid including its header.
struct _lcm_t;

namespace bridges {

/// Message passed to a handler; valid until the handler returns.
struct LcmMessage {
  std::string_view channel;
  std::span<const std::byte> payload;
  std::int64_t wall_utime = 0;  ///< arrival by the wall clock
};

struct LcmSubscription;
class UdpInbox;

/// Tested connection to LCM.  liblcm 1.3.1 aborts or spins on a connection that does not work, so the constructor tests
/// it first and throws BusError.  It takes ten seconds to detect a multicast group blocked by a firewall. liblcm sends,
/// and receives over tcpq and memq.  Over udpm, UdpReceiver receives: with ttl=0 messages from processes of this
/// machine to the multicast group, with a larger ttl all messages to it.
class LcmConnection {
 public:
  using Handler = void (*)(const LcmMessage& message, void* user);
  enum class Handled {
    all,   ///< all messages have been handled
    more,  ///< more messages may have arrived
    lost,  ///< the connection is lost
  };

  explicit LcmConnection(const std::string& url = {});
  ~LcmConnection();
  LcmConnection(const LcmConnection&) = delete;
  LcmConnection& operator=(const LcmConnection&) = delete;

  const std::string& url() const { return url_; }
  /// Returns a descriptor that is readable when handle() has a message.
  int fd() const { return fd_; }
  /// Subscribes to a channel.  Received messages are buffered until handle(): over udpm in the kernel buffer, otherwise
  /// in liblcm without limit.  Thread-safe.  Throws BusError.
  LcmSubscription* subscribe(const std::string& channel, Handler handler, void* user);
  LcmSubscription* subscribe_to_all(Handler handler, void* user);
  /// Ends a subscription.  A last call of the handler may still be in progress when this returns.
  void unsubscribe(LcmSubscription* subscription);
  /// Publishes a message; returns false when LCM refused it.
  bool publish(const char* channel, std::span<const std::byte> payload);
  /// Calls the handlers for a few received messages, without waiting.  By one thread at a time.
  Handled handle();
  /// Returns the number of bytes received by handle() over udpm; otherwise 0.  Thread-safe.
  std::uint64_t received_bytes() const;
  /// Returns whether publish() and handle() may block on another program, as over tcpq.
  bool may_block() const { return is_tcp_; }
  /// Makes a blocked publish() return, permanently.
  void shut_down();

 private:
  struct Subscriptions;
  struct LcmDeleter {
    void operator()(_lcm_t* lcm) const;
  };
  LcmSubscription* add(const std::string& channel, Handler handler, void* user);
  void open_udp(const LcmEndpoint& endpoint);
  void open_liblcm_receiver();
  /// Sends itself a message; throws BusError when it is not received.
  void test_itself();

  std::string url_;
  bool is_tcp_ = false;
  std::unique_ptr<Subscriptions> subscriptions_;  // outlives the handlers of liblcm
  std::unique_ptr<_lcm_t, LcmDeleter> lcm_;
  std::unique_ptr<UdpInbox> udp_;
  int fd_ = -1;
};

/// Schedule of pauses in which a background receiver lets messages accumulate.  In a stream of small messages, waking
/// for each message costs more than receiving it; the kernel buffer holds those that arrive in a pause.
class GatherPauses {
 public:
  static constexpr std::chrono::milliseconds until_next_check{1}, length{1};

  explicit GatherPauses(const LcmConnection& connection) : connection_(connection) {}
  /// Returns the time to wait for the next messages; negative: unlimited.
  std::chrono::milliseconds wait() const { return polls_ == 0 ? std::chrono::milliseconds(-1) : until_next_check; }
  /// Returns whether to pause now; called after the wait, and after receiving if messages had arrived.
  bool due(bool has_arrivals);

 private:
  static constexpr int polls_before_pause = 8;
  /// Limit of bytes per check for a pause: larger amounts, such as images, need the whole kernel buffer.
  static constexpr std::uint64_t max_bytes_of_check = 16 << 10;

  const LcmConnection& connection_;
  std::uint64_t bytes_ = 0;
  int polls_ = 0;
};

/// Waits until one of the descriptors is readable.  `second` may be -1.  Returns false on time-out or signal.
bool wait_readable(int first, int second, std::chrono::milliseconds timeout);

}  // namespace bridges
