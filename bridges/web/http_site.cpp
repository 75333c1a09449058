// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/http_site.hpp"

#include <algorithm>
#include <array>

#include "bridges/web/web_error.hpp"

namespace bridges {

namespace {

using Header = std::pair<std::string_view, std::string_view>;

constexpr std::array<Header, 6> headers_of_all = {{
    {"Content-Security-Policy",
     "default-src 'self'; connect-src 'self'; img-src 'self' blob: data:; object-src 'none'; base-uri 'none'; "
     "form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Referrer-Policy", "no-referrer"},
}};

bool has_allowed_host(const HttpRequest& request, const AccessRules& rules) {
  return request.hosts.size() == 1 && is_host_allowed(request.hosts.front(), rules);
}

/// A text of a client, as it may be shown: short, without control characters.
std::string shown(std::string_view text) {
  std::string result(text.substr(0, 100));
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return result;
}

std::string_view query_of(std::string_view target) {
  const std::size_t begin = target.find('?');
  return begin == std::string_view::npos ? std::string_view() : target.substr(begin + 1);
}

HttpAnswer wrong_host(const HttpRequest& request) {
  return plain_answer(403, "Host '" + (request.hosts.empty() ? "" : shown(request.hosts.front())) +
                               "': must be localhost, 127.0.0.1, [::1] or the host of this server\n");
}

}  // namespace

std::span<const Header> security_headers() {
  return headers_of_all;
}

HttpAnswer plain_answer(unsigned status, std::string text) {
  HttpAnswer answer{status, {}, std::make_shared<const std::string>(std::move(text))};
  answer.headers = {{"Content-Type", "text/plain; charset=utf-8"}, {"Cache-Control", "no-store"}};
  return answer;
}

HttpSite::HttpSite(AccessRules rules, const std::string& page_directory)
    : rules_(std::move(rules)), files_(page_directory) {
  for (const std::string& origin : rules_.origins)
    if (!is_origin(origin))
      throw WebError("origin '" + shown(origin) +
                     "': must be scheme://host or scheme://host:port, such as https://example.org");
}

HttpAnswer HttpSite::answer(const HttpRequest& request) {
  // First of all: a page of another site could reach this server by DNS rebinding, with its own name as the host.
  if (!has_allowed_host(request, rules_)) return wrong_host(request);
  if (request.method != "GET" && request.method != "HEAD") {
    HttpAnswer refused = plain_answer(405, "only GET and HEAD\n");
    refused.headers.emplace_back("Allow", "GET, HEAD");
    return refused;
  }
  const auto path = path_of(request.target);
  if (!path) return plain_answer(404, "no such file\n");
  if (const auto hash = asset_of(*path)) return answer_asset(*hash);
  return answer_file(request, *path);
}

HttpAnswer HttpSite::answer_file(const HttpRequest& request, std::string_view path) {
  const PageFile* file = nullptr;
  try {
    file = files_.find(path);
  } catch (const WebError& error) {  // of a folder that changes during development
    return plain_answer(500, std::string(error.what()) + "\n");
  }
  if (file == nullptr && path == "/favicon.ico") return {204, {}, nullptr};
  if (file == nullptr) return plain_answer(404, "no such file\n");

  // Browsers ask each time, and get the bytes only when they have changed
  HttpAnswer answer;
  answer.headers = {{"ETag", file->etag}, {"Cache-Control", "no-cache"}, {"Vary", "Accept-Encoding"}};
  if (lists_etag(request.if_none_match, file->etag)) {
    answer.status = 304;
    return answer;
  }
  answer.headers.emplace_back("Content-Type", file->content_type);
  const bool compressed = file->gzipped && accepts_gzip(request.accept_encoding);
  if (compressed) answer.headers.emplace_back("Content-Encoding", "gzip");
  answer.body = compressed ? file->gzipped : file->bytes;
  return answer;
}

HttpAnswer HttpSite::answer_asset(std::uint64_t hash) {
  const std::lock_guard lock(mutex_);
  const auto asset = assets_.find(hash);
  if (asset == assets_.end()) return plain_answer(404, "no such asset\n");
  HttpAnswer answer{200, {}, asset->second};
  answer.headers = {{"Content-Type", "application/octet-stream"},
                    {"Cache-Control", "private, max-age=31536000, immutable"}};
  return answer;
}

std::variant<HttpAnswer, ChosenProtocol> HttpSite::choose(const HttpRequest& request) {
  // Origin of the request
  if (!has_allowed_host(request, rules_)) return wrong_host(request);
  for (const std::string_view origin : request.origins)
    if (request.origins.size() > 1 || !is_origin_allowed(origin, request.hosts.front(), rules_))
      return plain_answer(403, "Origin '" + shown(origin) + "': pages of this site may not connect\n");

  // Subprotocol
  const std::lock_guard lock(mutex_);
  const auto offered = header_list(request.subprotocols);
  std::string known;
  for (const ChosenProtocol& each : protocols_) {
    const bool chosen =
        each.name.empty() ? offered.empty() : std::find(offered.begin(), offered.end(), each.name) != offered.end();
    if (chosen) {
      if (each.protocol->admits(query_of(request.target))) return each;
      return plain_answer(403, "the token of the page is needed: ws://HOST:PORT/?t=TOKEN\n");
    }
    known += (known.empty() ? "" : ", ") + (each.name.empty() ? "none" : each.name);
  }
  return plain_answer(400, "subprotocol '" + shown(request.subprotocols) + "': must be one of: " + known + "\n");
}

void HttpSite::set_asset(std::uint64_t hash, std::span<const std::byte> bytes) {
  auto copy = std::make_shared<const std::string>(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::lock_guard lock(mutex_);
  assets_[hash] = std::move(copy);
}

void HttpSite::clear_assets() {
  std::map<std::uint64_t, Bytes> removed;
  const std::lock_guard lock(mutex_);
  assets_.swap(removed);
}

void HttpSite::add_protocol(std::string name, std::shared_ptr<WebProtocol> protocol) {
  const std::lock_guard lock(mutex_);
  protocols_.push_back({std::move(name), std::move(protocol)});
}

}  // namespace bridges
