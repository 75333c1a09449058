// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "bridges/web/http_check.hpp"
#include "bridges/web/page_files.hpp"
#include "bridges/web/web_protocol.hpp"

namespace bridges {

/// Head of an HTTP request: the fields that the site reads.
struct HttpRequest {
  std::string_view method;                       ///< such as `GET`
  std::string_view target;                       ///< path and query
  std::vector<std::string_view> hosts, origins;  ///< all `Host` and `Origin` headers
  std::string_view accept_encoding;              ///< `Accept-Encoding`
  std::string_view if_none_match;                ///< `If-None-Match`
  std::string_view subprotocols;                 ///< `Sec-WebSocket-Protocol`
};

/// Answer to an HTTP request.
struct HttpAnswer {
  unsigned status = 200;                                     ///< code
  std::vector<std::pair<std::string, std::string>> headers;  ///< in addition to those of all answers
  std::shared_ptr<const std::string> body;                   ///< content; null: none
};

/// Subprotocol that was chosen for a WebSocket.
struct ChosenProtocol {
  std::string name;                       ///< as the client offered it
  std::shared_ptr<WebProtocol> protocol;  ///< its sessions
};

/// Web site of a server, without the network: page, assets, and the rules for requests.
class HttpSite {
 public:
  HttpSite(AccessRules rules, const std::string& page_directory);

  /// Answers a request that opens no WebSocket.
  HttpAnswer answer(const HttpRequest& request);
  /// Chooses the subprotocol of a WebSocket, or answers why there is none.
  std::variant<HttpAnswer, ChosenProtocol> choose(const HttpRequest& request);

  /// See WebServer; thread-safe.
  void set_asset(std::uint64_t hash, std::span<const std::byte> bytes);
  void clear_assets();
  void add_protocol(std::string name, std::shared_ptr<WebProtocol> protocol);

 private:
  using Bytes = std::shared_ptr<const std::string>;

  HttpAnswer answer_file(const HttpRequest& request, std::string_view path);
  HttpAnswer answer_asset(std::uint64_t hash);

  const AccessRules rules_;
  PageFiles files_;
  std::mutex mutex_;
  std::map<std::uint64_t, Bytes> assets_;
  std::vector<ChosenProtocol> protocols_;
};

/// Returns the headers that every answer has: they keep other sites from showing or reading it.
std::span<const std::pair<std::string_view, std::string_view>> security_headers();
/// Returns an answer in plain text.
HttpAnswer plain_answer(unsigned status, std::string text);

}  // namespace bridges
