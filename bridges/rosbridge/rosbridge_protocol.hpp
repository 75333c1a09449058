// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/ros2/topic_hub.hpp"
#include "bridges/rosbridge/ros_json.hpp"
#include "bridges/rosbridge/rosapi.hpp"
#include "bridges/web/web_exchange.hpp"
#include "bridges/web/web_protocol.hpp"

namespace bridges::rosbridge {

class Session;

/// Request of a client that may control.
struct Request {
  enum class Kind { service, command };
  int client = 0;  ///< number of the connection
  Kind kind = Kind::service;
  std::string command;             ///< of a service: that of `sim.control`
  double value = 0;                ///< of the command
  std::string text;                ///< of the command
  std::string service, id;         ///< of the call
  std::string vehicle, channel;    ///< of a command of a vehicle
  std::vector<std::byte> payload;  ///< of it
};

/// rosbridge v2 (JSON over WebSocket) without the network: topics of LCM channels (ros2::TopicHub), each encoded only
/// while a client has subscribed to it, commands to vehicles, the services of rosapi and those of the run.
///
/// Its functions for all threads only put something into the box of a WebExchange; in the thread of the server
/// deliver() passes it on.  A client that does not read loses its oldest messages, and gets a status with their number.
class Protocol final : public WebProtocol {
 public:
  static constexpr std::size_t max_queued_bytes = std::size_t{16} << 20;  ///< of messages in CDR, and of answers
  static constexpr std::size_t max_queued_messages = 1024;                ///< that wait for one client
  static constexpr std::size_t max_waiting_requests = 256;                ///< of one client
  static constexpr std::size_t max_waiting_texts = 1000;                  ///< answers to one client
  static constexpr std::size_t max_subscriptions = 4096;                  ///< of one client
  static constexpr std::size_t max_advertised = 256;                      ///< topics of one client

  /// `may_control`: clients may command vehicles and use the services of the run.
  Protocol(WebPost post, bool may_control)
      : may_control_(may_control),
        exchange_([this](Box box) { deliver(std::move(box)); }, max_waiting_requests, std::move(post)) {}
  /// Demands a token in the address, `?t=TOKEN`; before the first client.
  void require_token(std::function<bool(std::string_view)> is_token) { is_token_ = std::move(is_token); }

  std::unique_ptr<WebSession> open(WebLink& link) override;
  std::size_t max_message_bytes() const override;
  bool admits(std::string_view query) const override;

  // Thread-safe:

  int clients() const { return exchange_.clients(); }
  /// Returns the number of subscriptions so far: it increases with each.
  std::uint64_t subscriptions() const { return subscriptions_.load(); }
  /// Passes a message on, published at this UTC, us since 1970, with the next flush().
  void message(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload);
  /// Sends the messages so far.  Call it after each step.
  void flush() { exchange_.flush(); }
  /// Sets the topics on which clients may command.
  void set_commands(std::vector<CommandTopic> commands);
  /// Sends what was held back and is due now.  Call some thirty times per second.
  void release();
  /// Returns the next request, or std::nullopt.
  std::optional<Request> take_request() { return exchange_.take_request(); }
  /// Answers the call of a service; without effect when the client has left.
  void reply(const Request& request, bool ok, const std::string& text);

 private:
  friend class Session;
  using Bytes = ros2::TopicReader::Bytes;

  struct Reply {
    int client;
    std::string text;
  };
  /// Input of other threads since deliver().
  struct Box : WebBox {
    ros2::WaitingMessages waiting;
    std::optional<std::vector<CommandTopic>> commands;
    std::vector<Reply> replies;
  };
  /// Topic as clients get it: its type, and its last message in JSON, which all of them share.
  struct Shown {
    RosType type;
    std::string begin;  ///< of each text
    Bytes cdr, text;
  };

  void deliver(Box box);
  void count_subscription(std::size_t topic, int change);
  void left(const Session& session);
  void warn_of_drops();
  Graph graph() const { return {topics_.topics(), commands_, may_control_, utime_}; }
  /// Returns the `publish` of a message.
  Bytes publish_text(std::size_t topic, const Bytes& cdr);
  /// Returns the type of a command.  Throws WebError.
  const RosType& command_type(const CommandTopic::Type& type);

  const bool may_control_;
  std::function<bool(std::string_view)> is_token_;  // empty: none is needed
  std::atomic<std::uint64_t> subscriptions_ = 0;
  std::atomic<int> held_ = 0;  // subscriptions that hold messages back
  WebExchange<Box, Request, Session> exchange_;
  ros2::TopicHub topics_;

  // Members of the server thread:
  std::map<std::string, CommandTopic, std::less<>> commands_;  // by topic
  std::map<std::size_t, Shown> shown_;                         // by topic
  std::map<std::string, RosType, std::less<>> command_types_;  // by name
  std::int64_t utime_ = 0;
  bool warned_of_drops_ = false;
};

}  // namespace bridges::rosbridge
