// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/http_check.hpp"

#include <arpa/inet.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace bridges {

namespace {

constexpr std::size_t longest_host = 255;

bool is_letter_or_digit(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](char c) { return lower(c); });
  return result;
}

std::string_view without_spaces(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

bool is_port(std::string_view text) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value <= 65535;
}

/// Splits `host:port` where the port begins; an address in brackets may contain colons.
std::size_t end_of_host(std::string_view authority) {
  const bool in_brackets = authority.starts_with('[');
  const std::size_t end = authority.find(in_brackets ? ']' : ':');
  if (end == std::string_view::npos) return in_brackets ? end : authority.size();
  return in_brackets ? end + 1 : end;
}

bool is_name(std::string_view host) {
  return !host.empty() && std::all_of(host.begin(), host.end(),
                                      [](char c) { return is_letter_or_digit(c) || c == '-' || c == '.' || c == '_'; });
}

std::string name_of_machine() {
  std::array<char, longest_host + 1> name{};
  if (gethostname(name.data(), longest_host) != 0) return {};
  return lower(name.data());
}

/// Parts of an origin: `scheme` with `://`, and the rest.
struct OriginParts {
  std::string scheme;
  std::string_view authority;
};

std::optional<OriginParts> parts_of_origin(std::string_view origin) {
  const std::size_t end = origin.find("://");
  if (end == std::string_view::npos || end == 0) return std::nullopt;
  return OriginParts{lower(origin.substr(0, end)), origin.substr(end + 3)};
}

/// Returns the quality of one part of a list of encodings: false for `q=0`.
bool is_acceptable(std::string_view parameters) {
  const std::size_t q = parameters.find("q=");
  if (q == std::string_view::npos) return true;
  return without_spaces(parameters.substr(q + 2)).find_first_not_of("0.") != std::string_view::npos;
}

}  // namespace

std::optional<std::string> host_of(std::string_view authority) {
  // Host and port
  const std::size_t end = end_of_host(authority);
  if (end == std::string_view::npos || end > longest_host) return std::nullopt;
  std::string_view host = authority.substr(0, end);
  const std::string_view port = authority.substr(end);
  if (!port.empty() && (port.front() != ':' || !is_port(port.substr(1)))) return std::nullopt;

  // A name, or an IPv6 address in brackets
  if (!host.starts_with('[')) return is_name(host) ? std::optional(lower(host)) : std::nullopt;
  host = host.substr(1, host.size() - 2);
  if (host.find(':') == std::string_view::npos || !is_address(host)) return std::nullopt;
  return lower(host);
}

bool is_address(std::string_view host) {
  // inet_pton() reads to the first zero byte.
  if (host.find_first_not_of("0123456789abcdefABCDEF:.") != std::string_view::npos) return false;
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  const std::string text(host);
  return inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 || inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
}

bool is_any_address(std::string_view host) {
  return host == "0.0.0.0" || host == "::";
}

bool is_host_allowed(std::string_view header, const AccessRules& rules) {
  const std::optional<std::string> host = host_of(header);
  if (!host) return false;
  if (*host == "localhost" || *host == "127.0.0.1" || *host == "::1" || *host == lower(rules.host)) return true;
  return is_any_address(rules.host) && (is_address(*host) || *host == name_of_machine());
}

bool is_origin_allowed(std::string_view origin, std::string_view host, const AccessRules& rules) {
  // Applications, and sites that are always permitted
  if (origin == "file://" || origin == "https://app.foxglove.dev") return true;
  const auto parts = parts_of_origin(origin);
  if (!parts || !is_origin(origin)) return false;
  if (parts->scheme == "http" && host_of(parts->authority) == "localhost") return true;

  // The page of this server; by https when a proxy in front of it encrypts
  if ((parts->scheme == "http" || parts->scheme == "https") && lower(parts->authority) == lower(host)) return true;
  return std::any_of(rules.origins.begin(), rules.origins.end(),
                     [&](const std::string& each) { return lower(each) == lower(origin); });
}

bool is_origin(std::string_view text) {
  const auto parts = parts_of_origin(text);
  if (!parts || !std::all_of(parts->scheme.begin(), parts->scheme.end(), is_letter_or_digit)) return false;
  return host_of(parts->authority).has_value();
}

std::optional<std::string_view> path_of(std::string_view target) {
  const std::string_view path = target.substr(0, target.find('?'));
  if (!path.starts_with('/')) return std::nullopt;
  constexpr std::string_view others = "-._~/";
  const bool plain = std::all_of(path.begin(), path.end(), [&](char c) {
    return is_letter_or_digit(c) || others.find(c) != std::string_view::npos;
  });
  return plain ? std::optional(path) : std::nullopt;
}

bool has_token(std::string_view query, const std::function<bool(std::string_view)>& is_token) {
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view part = query.substr(0, end);
    if (part.starts_with("t=") && is_token(part.substr(2))) return true;
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return false;
}

std::optional<std::uint64_t> asset_of(std::string_view path) {
  constexpr std::string_view folder = "/asset/";
  if (!path.starts_with(folder) || path.size() != folder.size() + 16) return std::nullopt;
  const std::string_view digits = path.substr(folder.size());
  if (digits.find_first_not_of("0123456789abcdef") != std::string_view::npos) return std::nullopt;
  std::uint64_t hash = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), hash, 16);
  return hash;
}

std::vector<std::string_view> header_list(std::string_view header, std::size_t limit) {
  std::vector<std::string_view> parts;
  while (!header.empty() && parts.size() < limit) {
    const std::size_t end = std::min(header.find(','), header.size());
    const std::string_view part = without_spaces(header.substr(0, end));
    if (!part.empty()) parts.push_back(part);
    header.remove_prefix(std::min(end + 1, header.size()));
  }
  return parts;
}

bool accepts_gzip(std::string_view header) {
  bool any = false;
  for (const std::string_view part : header_list(header)) {
    const std::size_t end = std::min(part.find(';'), part.size());
    const std::string coding = lower(without_spaces(part.substr(0, end)));
    const bool accepted = is_acceptable(part.substr(end));
    if (coding == "gzip") return accepted;
    if (coding == "*") any = accepted;
  }
  return any;
}

bool lists_etag(std::string_view header, std::string_view etag) {
  for (std::string_view part : header_list(header)) {
    if (part.starts_with("W/")) part.remove_prefix(2);
    if (part == etag || part == "*") return true;
  }
  return false;
}

}  // namespace bridges
