// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace bridges {

/// WebSocket message to a client; its bytes are shared between clients.
struct WebFrame {
  std::shared_ptr<const std::string> bytes;  ///< content
  bool is_text = true;                       ///< text in UTF-8, or binary
};

/// Codes of the WebSocket protocol with which a server closes a connection.
enum class WebClose : std::uint16_t { going_away = 1001, bad_payload = 1007, policy = 1008, try_later = 1013 };

/// Connection of a client, as its session sees it.
class WebLink {
 public:
  virtual ~WebLink() = default;
  /// Returns the number of the client, which no other client of this server has had.
  virtual int number() const = 0;
  /// Announces that WebSession::next() has a frame.
  virtual void wake() = 0;
  /// Closes the connection after the frames that WebSession::next() still returns.  `reason`: at most 120 bytes.
  virtual void close(WebClose code, std::string reason) = 0;
};

/// Client of a subprotocol: decides what to send, and in which order.  Sending pulls: a session keeps its own bounded
/// queue and may replace what has not been sent.  All member functions are called in the thread of the server; the
/// destructor, when the client has left.
class WebSession {
 public:
  virtual ~WebSession() = default;
  /// Receives a message.
  virtual void receive(std::string_view bytes, bool is_text) = 0;
  /// Takes the next frame to send, when the one before has been passed to the system.  Returns false if there is none.
  virtual bool next(WebFrame& frame) = 0;
  /// Returns true while the client has not introduced itself, for which it has ten seconds.
  virtual bool awaits_greeting() const { return false; }
  /// Returns true when the client has given the token of the page.
  virtual bool has_token() const { return false; }
};

/// WebSocket subprotocol: makes a session for each client.
class WebProtocol {
 public:
  virtual ~WebProtocol() = default;
  /// Opens the session of a new client.  Called in the thread of the server; `link` lives longer than the session.
  virtual std::unique_ptr<WebSession> open(WebLink& link) = 0;
  /// Returns false for a client that may not connect, by the query of its address, such as `t=TOKEN`.  Called in the
  /// thread of the server.
  virtual bool admits(std::string_view /*query*/) const { return true; }
  /// Returns the size of the largest message that a client may send.
  virtual std::size_t max_message_bytes() const { return 64 * 1024; }
};

}  // namespace bridges
