// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/web/web_server.hpp"
#include "sim/bus/bus.hpp"
#include "viewer/page_data/page_request.hpp"

namespace viewer {

/// Messages of the channels that pages have subscribed to: keeps the newest of each, and sends it when it is due.  A
/// message is decoded only if it is sent.
class MessageFeed {
 public:
  /// Whether earlier messages are kept for a rewind.
  enum class Past { kept, forgotten };
  /// Maximum number of bytes of newest messages, and of earlier ones; further ones are lost, or the oldest.
  static constexpr std::size_t max_bytes = std::size_t{64} << 20, max_past_bytes = std::size_t{16} << 20;

  /// `server` must outlive this.
  MessageFeed(bridges::WebServer& server, Past past) : server_(server), past_mode_(past) {}

  /// Replaces the set of a page.
  void subscribe(int client, const std::vector<Subscription>& subscriptions);
  /// Forgets a page that has left.
  void remove(int client);
  bool empty() const { return channels_.empty(); }
  /// Takes a message that was published at a simulated time.
  void take(std::string_view channel, std::span<const std::byte> payload, std::int64_t time_us);
  /// Forgets all messages: another time of a log follows.
  void discard();
  /// Goes back to what was newest at a time, and sends it at once.
  void rewind(std::int64_t time_us);
  /// Sends what is due.  Call some thirty times per second of wall time.
  void flush();

 private:
  using Clock = std::chrono::steady_clock;

  struct Channel {
    std::int64_t time_us = 0;
    std::uint64_t number = 0;  ///< of the newest message; 0: none
    sim::Bytes payload;
    std::shared_ptr<const std::string> frame;  ///< of the newest message; null: not yet made
  };
  struct Reader {
    Subscription subscription;
    Clock::time_point due{};
    std::uint64_t sent = 0;  ///< number of the message that was sent last
  };
  struct Earlier {
    std::string channel;
    std::int64_t time_us = 0;
    sim::Bytes payload;
  };

  void set(Channel& place, std::span<const std::byte> payload, std::int64_t time_us);
  void keep(std::string_view channel, std::span<const std::byte> payload, std::int64_t time_us);
  void send(int client, Reader& reader, Clock::time_point now);
  void drop_unread_channels();

  bridges::WebServer& server_;
  const Past past_mode_;
  std::map<std::string, Channel, std::less<>> channels_;
  std::map<int, std::vector<Reader>> readers_;  // by client
  std::uint64_t last_number_ = 0;
  std::size_t bytes_ = 0, past_bytes_ = 0;
  std::deque<Earlier> past_;
};

}  // namespace viewer
