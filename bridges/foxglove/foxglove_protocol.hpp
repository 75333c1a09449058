// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/foxglove/foxglove_text.hpp"
#include "bridges/ros2/topic_hub.hpp"
#include "bridges/web/web_exchange.hpp"
#include "bridges/web/web_protocol.hpp"

namespace bridges::foxglove {

class Session;

/// Request of a client that may control.
struct Request {
  enum class Kind { service, parameter, playback };
  int client = 0;  ///< number of the connection
  Kind kind = Kind::service;
  std::string command;  ///< of `sim.control`, except for a playback request
  double value = 0;     ///< of the command
  std::string text;     ///< of the command
  PlaybackRequest playback;
  ServiceCall call;                ///< of a service, without its payload
  std::optional<std::string> id;   ///< of a parameter request that is answered
  std::vector<std::string> names;  ///< of its parameters
};

/// Subprotocols `foxglove.sdk.v1` and `foxglove.websocket.v1`, which are the same, without the network: passes the
/// messages of LCM channels on as topics in CDR (ros2::TopicHub), each only while a client has subscribed to it.
///
/// Its functions for all threads only put something into the box of a WebExchange; in the thread of the server
/// deliver() encodes it.  A client that does not read loses its oldest messages, and gets a warning with their number.
class Protocol final : public WebProtocol {
 public:
  static constexpr std::size_t max_queued_bytes = std::size_t{8} << 20;    ///< that wait for one client
  static constexpr std::size_t max_queued_messages = 1024;                 ///< that wait for one client
  static constexpr std::size_t max_latched_bytes = std::size_t{32} << 20;  ///< of latched topics, for one client
  static constexpr std::size_t max_waiting_requests = 32;                  ///< of one client
  static constexpr std::size_t max_waiting_texts = 1000;                   ///< answers to one client

  explicit Protocol(WebPost post)
      : exchange_([this](Box box) { deliver(std::move(box)); }, max_waiting_requests, std::move(post)) {}
  /// Demands a token in the address, `?t=TOKEN`; before the first client.
  void require_token(std::function<bool(std::string_view)> is_token) { is_token_ = std::move(is_token); }

  std::unique_ptr<WebSession> open(WebLink& link) override;
  std::size_t max_message_bytes() const override { return max_client_message_bytes; }
  bool admits(std::string_view query) const override;

  // Thread-safe:

  /// Returns the number of clients.
  int clients() const { return exchange_.clients(); }
  /// Returns the number of subscriptions so far: it increases with each.
  std::uint64_t subscriptions() const { return subscriptions_.load(); }
  /// Introduces the server to later clients, who wait for it.
  void introduce(ServerInfo info);
  /// Passes a message on, published at this UTC, us since 1970, with the next flush().
  void message(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload);
  /// Sends the messages so far.  Call it after each step.
  void flush() { exchange_.flush(); }
  /// Sets the time that clients show.
  void show_time(std::int64_t utime);
  /// Announces that the time was set, so that later messages may be older than those before.
  void jump(std::int64_t utime);
  /// Sets what clients know of pause and speed.
  void set_state(const PlaybackState& state);
  /// Returns the next request, or std::nullopt.
  std::optional<Request> take_request() { return exchange_.take_request(); }
  /// Answers a request; without effect when the client has left.
  void reply(const Request& request, bool ok, std::string text);

 private:
  friend class Session;

  struct Reply {
    Request request;
    bool ok = false;
    std::string text;
  };
  /// Input of other threads since deliver().
  struct Box : WebBox {
    ros2::WaitingMessages waiting;
    std::optional<ServerInfo> info;
    std::optional<std::int64_t> time;
    std::optional<PlaybackState> state;
    std::vector<Reply> replies;
  };

  void deliver(Box box);
  void process_jump(std::int64_t utime);
  void process(const Reply& reply);
  void process(const PlaybackState& state);
  /// Counts a subscription that begins (1) or ends (-1).
  void count_subscription(std::size_t topic, int change);
  void left(const Session& session);
  /// Warns once that a client does not get all messages.
  void warn_of_drops();

  std::function<bool(std::string_view)> is_token_;  // empty: none is needed
  std::atomic<std::uint64_t> subscriptions_ = 0;
  WebExchange<Box, Request, Session> exchange_;
  ros2::TopicHub topics_;

  // Members of the server thread:
  std::optional<ServerInfo> info_;
  PlaybackState state_;
  std::optional<std::int64_t> time_;
  bool warned_of_drops_ = false;
};

}  // namespace bridges::foxglove
