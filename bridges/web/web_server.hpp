// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/web/page_output.hpp"
#include "bridges/web/view_request.hpp"
#include "bridges/web/web_error.hpp"
#include "bridges/web/web_protocol.hpp"

namespace bridges {

/// Settings of a WebServer.
struct WebOptions {
  std::string host = "127.0.0.1";    ///< address or name to listen on; the default listens on ::1 too, where it exists
  std::uint16_t port = 8765;         ///< first port to try; 0: any free one
  int port_tries = 20;               ///< number of ports to try: the next one if a port is taken
  std::string token;                 ///< what a page needs to steer; empty: 128 random bits
  std::vector<std::string> origins;  ///< further web sites whose pages may connect, such as https://example.org
  std::string page_directory;        ///< folder with the page; empty: the page in the program
  std::size_t max_clients = 32;      ///< limit of WebSocket clients without the token
};

/// Server of the live page: files by HTTP, and WebSocket clients of the subprotocol `shoal.view.v1`
/// (docs/develop/view_protocol.md) and of further ones.  It has its own thread; every member function may be called in
/// any thread and does not wait for the network.  It knows bytes and the rules of access, not what is shown.
///
/// Clients that do not read cannot delay anything: the newest state replaces the one before, and texts are dropped when
/// 8 MB of them wait for one client.
class WebServer final : public PageOutput {
 public:
  /// Opens the port and starts the thread.  Throws WebError with the reason when no port is free or an option is
  /// invalid.
  explicit WebServer(const WebOptions& options);
  /// Says goodbye to the clients, for at most half a second, and joins the thread.
  ~WebServer() override;
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Returns the address of the page with the token: `http://127.0.0.1:8765/#t=...`.
  std::string url() const;
  /// Returns the port in use.
  std::uint16_t port() const;
  /// Returns the number of pages that receive states.  An atomic read: callers skip all work when it is 0.
  int clients() const override;

  /// Sends a binary state frame to all pages; bytes 4 to 7 are its sequence number.  A page that has not acknowledged
  /// the last two states gets the newest one later.  Without clients nothing is copied.
  void send_state(std::span<const std::byte> state) override;
  /// Sends a JSON text to the pages that are connected now.  If a page has not read 8 MB of texts its oldest texts are
  /// dropped, and it gets one `{"op":"dropped","count":n}` in their place.
  void send_text(std::string json) override;
  /// Sends a JSON text to all pages, and to each later one before anything else, in the order in which their `op` was
  /// retained first.  Replaces the previous text of this `op`.  In `hello` the server sets the key `control` for each
  /// page.  Throws WebError if a `hello` is not a JSON object.
  void retain(std::string_view op, std::string json) override;
  /// Makes bytes available as `GET /asset/HASH` (asset_name()).
  void set_asset(std::uint64_t hash, std::span<const std::byte> bytes) override;
  /// Removes all assets, for another scene.
  void clear_assets();

  /// Returns the next request of a page, or std::nullopt.  A page without the token is refused `control`, `play` and
  /// `seek` here; other requests carry `may_control`.
  std::optional<ViewRequest> take_request();
  /// Sends a JSON text to one page; without effect when it has left.
  void reply(int client, std::string json);
  /// Sends a binary message of a channel to one page, after texts and states.  It replaces the one of this channel that
  /// waits for the page; when 8 MB wait for the page it is lost.
  void send_message(int client, std::string_view channel, std::shared_ptr<const std::string> bytes);

  /// Sends a binary state to one page, which does not acknowledge it; without effect when it has left.  Four of them
  /// wait for a page at most: a further one replaces the oldest.
  void send_state_to(int client, std::span<const std::byte> state);

  /// Adds a WebSocket subprotocol; an empty name is for clients that offer none.  If a client offers several, the one
  /// added first is used; `shoal.view.v1` is before all.
  void add_protocol(std::string name, std::shared_ptr<WebProtocol> protocol);
  /// Runs a function in the thread of the server, in which all sessions of subprotocols live.
  void run_in_thread(std::function<void()> work);
  /// Returns true if the text is the token, in constant time; for further subprotocols.
  bool is_token(std::string_view text) const;
  /// Returns true if clients need the token to read too, because other machines can reach the port.
  bool needs_token_to_read() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Returns the name of an asset in its address: 16 hexadecimal digits.
std::string asset_name(std::uint64_t hash);

}  // namespace bridges
