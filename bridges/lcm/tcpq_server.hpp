// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bridges/base/bus_error.hpp"
#include "bridges/base/file_descriptor.hpp"

namespace bridges {

/// Patterns of channels of one client, as LCM has them: a subscription is a regular expression for the whole name.
class ChannelPatterns {
 public:
  static constexpr std::size_t max_patterns = 1000;      ///< of one client
  static constexpr std::size_t max_pattern_bytes = 256;  ///< of one pattern

  /// Adds a pattern: an extended regular expression of POSIX without `{` and back references, which take no time that
  /// grows faster than pattern times name.  Returns the rule that it breaks, or none.
  std::optional<std::string> add(std::string_view pattern);
  /// Removes one of the patterns that were added; returns false if there is none.
  bool remove(std::string_view pattern);
  bool matches(const std::string& channel);

 private:
  struct Compiled;
  std::multimap<std::string, std::shared_ptr<const Compiled>, std::less<>> patterns_;
  std::unordered_map<std::string, bool> known_;  // answers of matches()
};

/// What a client sends, taken from its bytes, which may be anything.
struct TcpqRequest {
  enum class Kind { publish = 1, subscribe = 2, unsubscribe = 3 };
  Kind kind = Kind::publish;
  std::string_view channel;  ///< or pattern
  std::string_view payload;  ///< of a publication
  std::size_t size = 0;      ///< bytes of the request
};
/// Reads the first request of these bytes; `request` is std::nullopt while it is incomplete.  Returns the rule that it
/// breaks, or none.  It refuses names, patterns and messages that are too long at their length.
std::optional<std::string> read_tcpq_request(std::string_view bytes, std::optional<TcpqRequest>& request);

/// Server of LCM URLs `tcpq://HOST:PORT`: passes each message on to the clients that subscribed to its channel, its
/// sender too, complete and in the order of its arrival.  Nothing is lost but by a client that does not read: when
/// `max_waiting_bytes` wait for it, it is disconnected with one line to `report`.  One thread, that of run().
class TcpqServer {
 public:
  struct Options {
    std::string host = "127.0.0.1";  ///< numeric IPv4 address
    std::uint16_t port = 7700;       ///< 0: any free one
    std::size_t max_waiting_bytes = std::size_t{64} << 20;
    std::size_t max_clients = 256;
  };
  using Report = std::function<void(const std::string& line)>;

  /// Listens.  Throws BusError with the reason.
  TcpqServer(const Options& options, Report report);
  ~TcpqServer();
  TcpqServer(const TcpqServer&) = delete;
  TcpqServer& operator=(const TcpqServer&) = delete;

  std::uint16_t port() const { return port_; }
  /// Serves until stop().  Throws BusError if the system fails.
  void run();
  /// Ends run().  May be called in any thread and in a signal handler.
  void stop() const;
  /// Returns the number of messages that clients published so far.  Thread-safe.
  std::uint64_t messages() const { return messages_.load(); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Client;

  void accept_clients();
  void read(Client& client);
  /// Carries out the complete requests of the bytes that were read.
  void take_requests(Client& client);
  void pass_on(const TcpqRequest& message);
  void send(Client& client);
  /// Disconnects a client, with a line that says why, at most ten a second; empty: it has left.
  void cut(Client& client, const std::string& why);
  void cut_silent_clients(Clock::time_point now);

  const Options options_;
  const Report report_;
  FileDescriptor listener_, wake_;
  std::uint16_t port_ = 0;
  std::list<Client> clients_;
  std::vector<char> part_ = std::vector<char>(std::size_t{256} << 10);  // of the bytes of a client
  Clock::time_point lines_since_{};
  int lines_ = 0;  // since then
  std::atomic<std::uint64_t> messages_ = 0;
};

}  // namespace bridges
