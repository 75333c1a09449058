#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <string>

#include "bridges/lcm/bus_error.hpp"

// LCM's own types; its header stays out of ours.
struct _lcm_t;
struct _lcm_subscription_t;
struct _lcm_recv_buf_t;

namespace bridges {

/// ttl=0: messages stay on this machine.  The kernel's default buffer holds some 160 small messages only.
inline constexpr const char* default_lcm_url = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";
/// LCM 1.3.1 never delivers larger messages.
inline constexpr std::size_t max_lcm_message_bytes = std::size_t{16} << 20;

/// The URL that is used: `url`, or LCM_DEFAULT_URL, or the default; recv_buf_size is added to a udpm URL
/// without. Throws BusError on a URL that LCM would misunderstand.
std::string resolve_lcm_url(const std::string& url);

/// The regular expression that matches this channel only.
std::string literal_channel_pattern(const std::string& channel);

/// A multicast address and port, "239.255.76.67" and 7667.  Host and port of the server for tcpq.
struct LcmEndpoint {
  std::string kind;  ///< "udpm", "mpudpm", "tcpq", "memq"
  std::string address;
  int port = 0;
};
LcmEndpoint lcm_endpoint(const std::string& resolved_url);

/// An lcm_t that works.  liblcm 1.3.1 aborts or spins on one that does not, so the constructor tries
/// everything first and throws BusError.  A group that a firewall drops takes it ten seconds to notice.
class LcmConnection {
 public:
  using Handler = void (*)(const _lcm_recv_buf_t* buffer, const char* channel, void* user);

  explicit LcmConnection(const std::string& url = {});
  ~LcmConnection();
  LcmConnection(const LcmConnection&) = delete;
  LcmConnection& operator=(const LcmConnection&) = delete;

  const std::string& url() const { return url_; }
  /// Readable when handle() has a message.
  int fd() const { return fd_; }
  /// `pattern`: an anchored regular expression.  The queue inside liblcm is made unlimited.
  _lcm_subscription_t* subscribe(const std::string& pattern, Handler handler, void* user);
  /// The handler may be at work for a last time while this returns.
  void unsubscribe(_lcm_subscription_t* subscription);
  /// False when LCM refused it.
  bool publish(const char* channel, std::span<const std::byte> payload);
  /// Calls the handlers for one message.  Only after fd() became readable.  False when the connection is
  /// lost.
  bool handle();
  /// publish() and handle() may wait for another program: tcpq.
  bool may_block() const { return is_tcp_; }
  /// Makes a blocked publish() return, for good.
  void shut_down();

 private:
  std::string url_;
  bool is_tcp_ = false;
  _lcm_t* lcm_ = nullptr;
  int fd_ = -1;
};

/// Waits until one of the descriptors is readable.  `second` may be -1.  False on time-out or signal.
bool wait_readable(int first, int second, std::chrono::milliseconds timeout);

}  // namespace bridges
