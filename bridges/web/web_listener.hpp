// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bridges/web/http_site.hpp"

namespace bridges {

/// Where a WebListener listens, and its limit.
struct ListenOptions {
  std::vector<std::string> addresses;  ///< numeric; the first one must work
  std::uint16_t port = 0;              ///< first port to try; 0: any free one
  int port_tries = 1;                  ///< number of ports to try
  std::size_t max_clients = 32;        ///< limit of WebSocket clients without the token of the page
};

/// Sockets of the web server, in their own thread: HTTP and WebSocket by Boost.Beast, which only the .cpp file
/// includes. What is answered and sent is decided by HttpSite and by the sessions of its subprotocols.
///
/// Limits: 16 KiB of headers, ten seconds for a request, a handshake or a greeting; max_clients WebSockets without the
/// token of the page, eight more with it or before they greet, and 64 further connections.  A client that does not
/// answer a ping within a minute is closed.
class WebListener {
 public:
  /// Opens the port and starts the thread.  `site` must live longer.  Throws WebError when no port is free.
  WebListener(const ListenOptions& options, HttpSite& site);
  /// Closes all connections, for at most half a second, and joins the thread.
  ~WebListener();
  WebListener(const WebListener&) = delete;
  WebListener& operator=(const WebListener&) = delete;

  /// Returns the port in use.
  std::uint16_t port() const;
  /// Runs a function in the thread.
  void post(std::function<void()> work);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bridges
