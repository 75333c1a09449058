// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/web/access_token.hpp"
#include "bridges/web/view_request.hpp"
#include "bridges/web/web_exchange.hpp"
#include "bridges/web/web_protocol.hpp"

namespace bridges {

class ViewSession;

/// Subprotocol of the live page (docs/develop/view_protocol.md), without the network: what each page gets, and when.
/// Its functions for the simulation only put a message into the box of a WebExchange; in the thread of the server
/// deliver() passes the messages on to the sessions.
class ViewProtocol final : public WebProtocol {
 public:
  static constexpr std::size_t max_queued_bytes = std::size_t{8} << 20;  ///< texts and messages that wait for one page
  static constexpr std::size_t max_unacknowledged = 2;                   ///< states
  static constexpr std::size_t max_waiting_requests = 32;                ///< of one page
  static constexpr std::size_t max_own_states = 4;                       ///< that wait for the page that asked for them

  /// `token_to_read`: pages without the token are closed.  `post`: may be set later, before the first client.
  ViewProtocol(const AccessToken& token, bool token_to_read) : token_(token), token_to_read_(token_to_read) {}
  /// Sets how to reach the thread of the server.
  void set_post(WebPost post) { exchange_.set_post(std::move(post)); }

  std::unique_ptr<WebSession> open(WebLink& link) override;

  /// See WebServer.
  int clients() const { return exchange_.clients(); }
  void send_state(std::span<const std::byte> state);
  void send_text(std::string json);
  void retain(std::string_view op, std::string json);
  void reply(int client, std::string json);
  void send_message(int client, std::string_view channel, std::shared_ptr<const std::string> bytes);
  void send_state_to(int client, std::span<const std::byte> state);
  std::optional<ViewRequest> take_request() { return exchange_.take_request(); }

 private:
  friend class ViewSession;
  using Text = std::shared_ptr<const std::string>;
  /// Client and channel.
  using Place = std::pair<int, std::string>;

  /// Text that every page gets; for `hello` the second one is that of a page that may control.
  struct Retained {
    std::string op;
    Text text, text_of_controller;
    std::uint64_t revision = 0;
  };
  /// Input of other threads since deliver().
  struct Box : WebBox {
    Text state;
    std::vector<Text> texts;
    std::vector<Retained> retained;
    std::vector<std::pair<int, Text>> replies;
    std::map<Place, Text> messages;  // newest
    std::vector<std::pair<int, Text>> own_states;

    /// Counts the bytes of a text that is put into the box, or a text for which there is no room.
    bool admit(const Text& text);
  };

  void deliver(const Box& box);
  void keep(Retained retained);
  void greeted();
  void left(const ViewSession& session, bool was_greeted);

  const AccessToken& token_;
  const bool token_to_read_;
  WebExchange<Box, ViewRequest, ViewSession> exchange_{[this](const Box& box) { deliver(box); }, max_waiting_requests};

  // Members of the server thread:
  std::vector<Retained> retained_;
  std::uint64_t revision_ = 0;
  Text last_state_;
};

/// One page.
class ViewSession final : public WebSession {
 public:
  ViewSession(ViewProtocol& protocol, WebLink& link) : protocol_(protocol), link_(link) {}
  ~ViewSession() override;
  void receive(std::string_view bytes, bool is_text) override;
  bool next(WebFrame& frame) override;
  bool awaits_greeting() const override { return !greeted_; }
  bool has_token() const override { return may_control_; }

 private:
  friend class ViewProtocol;
  using Text = ViewProtocol::Text;

  void greet(std::string_view token);
  void acknowledge(std::uint32_t sequence);
  void request(ViewRequest request, const std::string& id);
  void push(Text text);
  void drop_oldest(std::size_t room_for);
  void set_state(Text state);
  void add_own_state(Text state);
  bool take(Text bytes, bool is_text, WebFrame& frame);
  Text next_retained();
  Text next_text();
  Text next_state();
  void set_message(const std::string& channel, const Text& bytes);
  void drop_messages(std::size_t room_for);
  Text next_message();
  Text next_own_state();
  std::size_t queued_bytes() const { return texts_.bytes() + message_bytes_; }

  ViewProtocol& protocol_;
  WebLink& link_;
  bool greeted_ = false;
  bool may_control_ = false;
  std::vector<std::uint64_t> revisions_sent_;  // of the retained texts, in their order
  std::uint64_t revision_seen_ = 0;
  bool complete_ = false;  // every retained text has been sent once
  WebQueue<Text> texts_;
  std::uint64_t dropped_ = 0;
  std::size_t bytes_since_state_ = 0;
  Text state_;
  std::deque<Text> own_states_;
  std::deque<std::uint32_t> unacknowledged_;
  std::map<std::string, Text> messages_;  // newest that was not sent, by channel
  std::size_t message_bytes_ = 0;
  std::string last_channel_;  // of the message that was sent last
};

}  // namespace bridges
