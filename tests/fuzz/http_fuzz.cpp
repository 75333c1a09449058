// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "bridges/web/http_check.hpp"
#include "bridges/web/http_site.hpp"
#include "tests/fuzz/fuzz_target.hpp"

// Headers of a request, one in each line: method, target, Host, Origin, Accept-Encoding, If-None-Match, subprotocols.

namespace {

constexpr std::size_t lines = 7;

std::array<std::string_view, lines> lines_of(std::string_view text) {
  std::array<std::string_view, lines> result;
  for (std::string_view& line : result) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

void check_parts(const bridges::HttpRequest& request) {
  const std::string_view host = request.hosts.front(), origin = request.origins.front();
  if (const auto name = bridges::host_of(host)) {
    fuzz::require(!name->empty() && name->size() <= 255, "a host is bounded");
    fuzz::require(name->find_first_of("/@\\ \r\n") == std::string::npos, "a host has plain characters");
  }
  const bridges::AccessRules rules{"127.0.0.1", {}};
  if (bridges::is_host_allowed(host, rules))
    fuzz::require(host.find("evil") == std::string_view::npos, "no name of another site is accepted");
  if (bridges::is_origin_allowed(origin, "127.0.0.1:8765", rules))
    fuzz::require(origin.find("evil") == std::string_view::npos, "no page of another site is accepted");
  if (const auto path = bridges::path_of(request.target))
    fuzz::require(path->starts_with('/') && path->find_first_of("%\\ ") == std::string_view::npos, "paths are plain");
}

}  // namespace

SHOAL_FUZZ_TARGET(http) {
  static bridges::HttpSite site({"127.0.0.1", {"https://example.org"}}, "");
  const auto parts = lines_of(fuzz::text_of(input));
  const bridges::HttpRequest request{.method = parts[0],
                                     .target = parts[1],
                                     .hosts = {parts[2]},
                                     .origins = {parts[3]},
                                     .accept_encoding = parts[4],
                                     .if_none_match = parts[5],
                                     .subprotocols = parts[6]};
  check_parts(request);
  const bridges::HttpAnswer answer = site.answer(request);
  fuzz::require(answer.status >= 200 && answer.status < 500, "every request is answered");
  for (const auto& header : answer.headers)
    fuzz::require(header.second.find_first_of("\r\n") == std::string::npos, "no header is split");
  const auto choice = site.choose(request);
  fuzz::require(std::holds_alternative<bridges::HttpAnswer>(choice), "this site has no subprotocol");
}
