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

// LCM's own type; its header stays out of ours.
struct _lcm_t;

namespace bridges {

/// A message as a handler gets it; valid until the handler returns.
struct LcmMessage {
  std::string_view channel;
  std::span<const std::byte> payload;
  std::int64_t wall_utime = 0;  ///< when it arrived, by the wall clock
};

struct LcmSubscription;
class UdpInbox;

/// A connection to LCM that works.  liblcm 1.3.1 aborts or spins on one that does not, so the constructor tries
/// everything first and throws BusError.  A group that a firewall drops takes it ten seconds to notice.
///
/// liblcm sends, and receives over tcpq and memq.  Over udpm UdpReceiver receives: with ttl=0 what processes of this
/// machine send to the multicast group, with a larger ttl all messages sent to it.
class LcmConnection {
 public:
  using Handler = void (*)(const LcmMessage& message, void* user);
  enum class Handled {
    all,   ///< no further messages
    more,  ///< something more may have come
    lost,  ///< the connection is lost
  };

  explicit LcmConnection(const std::string& url = {});
  ~LcmConnection();
  LcmConnection(const LcmConnection&) = delete;
  LcmConnection& operator=(const LcmConnection&) = delete;

  const std::string& url() const { return url_; }
  /// Readable when handle() has a message.
  int fd() const { return fd_; }
  /// What comes waits for handle(): over udpm in the kernel's buffer, else in liblcm without limit.  From any thread.
  /// Throws BusError.
  LcmSubscription* subscribe(const std::string& channel, Handler handler, void* user);
  LcmSubscription* subscribe_to_all(Handler handler, void* user);
  /// The handler may be at work for a last time while this returns.
  void unsubscribe(LcmSubscription* subscription);
  /// False when LCM refused it.
  bool publish(const char* channel, std::span<const std::byte> payload);
  /// Calls the handlers for what has come, a few messages at most, without waiting.  By one thread at a time.
  Handled handle();
  /// What handle() has received so far, over udpm; else 0.  From any thread.
  std::uint64_t received_bytes() const;
  /// publish() and handle() may wait for another program: tcpq.
  bool may_block() const { return is_tcp_; }
  /// Makes a blocked publish() return, for good.
  void shut_down();

 private:
  struct Subscriptions;
  struct LcmDeleter {
    void operator()(_lcm_t* lcm) const;
  };
  LcmSubscription* add(const std::string& channel, Handler handler, void* user);
  void open_udp(const LcmEndpoint& endpoint);
  void open_liblcm_receiver();
  /// Throws BusError when what is sent does not come back.
  void test_itself();

  std::string url_;
  bool is_tcp_ = false;
  std::unique_ptr<Subscriptions> subscriptions_;  // outlives liblcm's handlers
  std::unique_ptr<_lcm_t, LcmDeleter> lcm_;
  std::unique_ptr<UdpInbox> udp_;
  int fd_ = -1;
};

/// When a thread that receives in the background lets messages gather for a while.  In a stream of small messages,
/// waking for each costs more than receiving it; the kernel's buffer holds those that arrive in a pause.
class GatherPauses {
 public:
  static constexpr std::chrono::milliseconds until_next_check{1}, length{1};

  explicit GatherPauses(const LcmConnection& connection) : connection_(connection) {}
  /// How long to wait for the next messages; negative: without limit.
  std::chrono::milliseconds wait() const { return polls_ == 0 ? std::chrono::milliseconds(-1) : until_next_check; }
  /// After the wait, and after receiving if there was something: whether to pause now.
  bool due(bool something_came);

 private:
  static constexpr int polls_before_pause = 8;
  /// More at a time are not small messages one by one: images need all the room that the kernel has.
  static constexpr std::uint64_t max_bytes_of_check = 16 << 10;

  const LcmConnection& connection_;
  std::uint64_t bytes_ = 0;
  int polls_ = 0;
};

/// Waits until one of the descriptors is readable.  `second` may be -1.  False on time-out or signal.
bool wait_readable(int first, int second, std::chrono::milliseconds timeout);

}  // namespace bridges
