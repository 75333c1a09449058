// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bridges {

/// Rules of who may use the server, by the headers of a request.
struct AccessRules {
  std::string host;                  ///< host at which the server listens
  std::vector<std::string> origins;  ///< further origins, as is_origin() accepts them
};

/// Reads `name`, `name:port`, `[address]` or `[address]:port`.  Returns the name or address in lower case, without
/// brackets; std::nullopt for any other text.
std::optional<std::string> host_of(std::string_view authority);
/// Returns true for an IPv4 or IPv6 address in numbers, without brackets.
bool is_address(std::string_view host);
/// Returns true for an address at which a server listens on all networks: 0.0.0.0 or ::.
bool is_any_address(std::string_view host);

/// Returns true if the `Host` header names this machine as localhost, 127.0.0.1, [::1] or the given host.  It keeps out
/// pages of other sites whose name was made to resolve to this machine (DNS rebinding).  A server that listens on all
/// networks also accepts addresses in numbers, which no such page has, and the name of the machine.
bool is_host_allowed(std::string_view header, const AccessRules& rules);
/// Returns true if a page of this origin may open a WebSocket: a page of this server (`host`: the accepted `Host`
/// header), a file of an application (`file://`), a server on this machine (`http://localhost`, any port),
/// `https://app.foxglove.dev`, or one of the rules.
bool is_origin_allowed(std::string_view origin, std::string_view host, const AccessRules& rules);
/// Returns true for `scheme://host` or `scheme://host:port`.
bool is_origin(std::string_view text);

/// Returns the path of a request target, without its query; std::nullopt if it does not begin with `/` or has
/// characters other than a-z, A-Z, 0-9 and `-._~/`.
std::optional<std::string_view> path_of(std::string_view target);
/// Returns true if the query of an address has a `t=TOKEN` that `is_token` accepts.
bool has_token(std::string_view query, const std::function<bool(std::string_view)>& is_token);
/// Returns the hash of a path `/asset/HASH`, with 16 lower-case hexadecimal digits; std::nullopt for another path.
std::optional<std::uint64_t> asset_of(std::string_view path);
/// Returns true if an `Accept-Encoding` header permits gzip.
bool accepts_gzip(std::string_view header);
/// Returns true if an `If-None-Match` header lists this entity tag, which includes its quotes.
bool lists_etag(std::string_view header, std::string_view etag);
/// Returns the comma-separated parts of a header, without white space; at most `limit`.
std::vector<std::string_view> header_list(std::string_view header, std::size_t limit = 32);

}  // namespace bridges
