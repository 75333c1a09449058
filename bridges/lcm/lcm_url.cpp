// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/lcm_url.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/base/number.hpp"

namespace bridges {
namespace {

struct UrlParts {
  std::string kind;
  std::string network;
  std::vector<std::pair<std::string, std::string>> options;
};

UrlParts split_url(const std::string& url) {
  const auto colon = url.find("://");
  if (colon == std::string::npos) refuse_url(url, "must look like udpm://239.255.76.67:7667?ttl=0");
  UrlParts parts;
  parts.kind = url.substr(0, colon);
  std::string rest = url.substr(colon + 3);
  std::string options;
  if (const auto question = rest.find('?'); question != std::string::npos) {
    options = rest.substr(question + 1);
    rest.resize(question);
  }
  parts.network = rest;
  while (!options.empty()) {
    const auto end = options.find_first_of("&,");
    const std::string option = options.substr(0, end);
    options = end == std::string::npos ? "" : options.substr(end + 1);
    const auto equals = option.find('=');
    parts.options.emplace_back(option.substr(0, equals), equals == std::string::npos ? "" : option.substr(equals + 1));
  }
  return parts;
}

LcmEndpoint endpoint_of(const std::string& url, const UrlParts& parts) {
  LcmEndpoint endpoint;
  endpoint.kind = parts.kind;
  if (parts.kind == "memq") return endpoint;
  const bool tcp = parts.kind == "tcpq";
  // Set the defaults of LCM.
  endpoint.address = tcp ? "127.0.0.1" : "239.255.76.67";
  endpoint.port = tcp ? 7700 : 7667;
  // Parse address and port.
  const auto colon = parts.network.find(':');
  if (colon != 0 && !parts.network.empty()) endpoint.address = parts.network.substr(0, colon);
  if (colon != std::string::npos) {
    const auto port = sim::exact_number<int>(std::string_view(parts.network).substr(colon + 1));
    if (!port || *port < 1 || *port > 65535)
      refuse_url(url, "the port must be 1 to 65535, got '" + parts.network.substr(colon + 1) + "'");
    endpoint.port = *port;
  }
  // Check the multicast address.
  in_addr address{};
  if (!tcp && (inet_pton(AF_INET, endpoint.address.c_str(), &address) != 1 || !IN_MULTICAST(ntohl(address.s_addr))))
    refuse_url(url, "'" + endpoint.address + "' is not a multicast address (224.0.0.0 to 239.255.255.255)");
  // Read the options.
  for (const auto& [key, value] : parts.options) {
    if (key == "ttl") endpoint.ttl = sim::exact_number<int>(value).value_or(0);
    if (key == "recv_buf_size") endpoint.recv_buf_bytes = sim::exact_number<int>(value).value_or(0);
  }
  return endpoint;
}

void check_options(const std::string& url, const UrlParts& parts) {
  const bool multicast = parts.kind == "udpm";
  std::set<std::string> seen;
  for (const auto& [key, value] : parts.options) {
    // Only options that Shoal's own receiver understands: any other would be silently ignored.
    if (!multicast || (key != "ttl" && key != "recv_buf_size"))
      refuse_url(url, "unknown option '" + key + "'" + (multicast ? "; known options: recv_buf_size, ttl" : ""));
    if (!seen.insert(key).second) refuse_url(url, "option '" + key + "' is given twice");
    const auto number = sim::exact_number<int>(value);
    if (key == "ttl" && (!number || *number < 0 || *number > 255))
      refuse_url(url, "ttl must be 0 to 255, got '" + value + "'");
    if (key == "recv_buf_size" && (!number || *number < 1))
      refuse_url(url, "recv_buf_size must be a number of bytes, got '" + value + "'");
  }
}

}  // namespace

std::string resolve_lcm_url(const std::string& url) {
  // Choose the URL, the environment variable or the default.
  std::string chosen = url;
  if (chosen.empty())
    if (const char* variable = std::getenv("LCM_DEFAULT_URL")) chosen = variable;
  if (chosen.empty()) chosen = default_lcm_url;
  // Refuse unsupported kinds and options.
  const UrlParts parts = split_url(chosen);
  if (parts.kind == "file") refuse_url(chosen, "the simulator writes logs with --record; lcm-logplayer plays them");
  if (parts.kind == "mpudpm")
    refuse_url(
        chosen,
        "mpudpm is not supported: a single datagram from any sender can crash liblcm's receiver; use udpm or tcpq");
  if (parts.kind != "udpm" && parts.kind != "tcpq" && parts.kind != "memq")
    refuse_url(chosen, "unknown kind '" + parts.kind + "'; known kinds: memq, tcpq, udpm");
  check_options(chosen, parts);
  const LcmEndpoint endpoint = endpoint_of(chosen, parts);
  if (parts.kind != "udpm") return chosen;
  // Require address and port, because the defaults of liblcm differ from those of the receiver.
  std::string resolved = "udpm://" + endpoint.address + ":" + std::to_string(endpoint.port);
  std::string before = "?";
  bool has_buffer = false;
  for (const auto& [key, value] : parts.options) {
    resolved += std::exchange(before, "&") + key + "=" + value;
    has_buffer |= key == "recv_buf_size";
  }
  return has_buffer ? resolved : resolved + before + "recv_buf_size=4194304";
}

LcmEndpoint lcm_endpoint(const std::string& resolved_url) {
  return endpoint_of(resolved_url, split_url(resolved_url));
}

std::string require_tcp_server(const std::string& url, const LcmEndpoint& endpoint) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  // Resolve the host.
  const std::string port = std::to_string(endpoint.port);
  if (const int error = getaddrinfo(endpoint.address.c_str(), port.c_str(), &hints, &found); error != 0)
    refuse_url(url, "host '" + endpoint.address + "': " + gai_strerror(error));
  // Try to connect, for at most 2 s.
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  int error = fd < 0 ? errno : 0;
  if (error == 0 && connect(fd, found->ai_addr, found->ai_addrlen) != 0) {
    error = errno;
    if (error == EINPROGRESS) {
      pollfd waiting{fd, POLLOUT, 0};
      socklen_t size = sizeof(error);
      if (poll(&waiting, 1, 2000) != 1)
        error = ETIMEDOUT;
      else
        getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
    }
  }
  std::array<char, INET_ADDRSTRLEN> numeric{};
  inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr, numeric.data(), numeric.size());
  freeaddrinfo(found);
  if (fd >= 0) close(fd);
  if (error != 0)
    refuse_url(url, "no LCM server at " + endpoint.address + ":" + port + " (" + std::strerror(error) +
                        "); start one (shoal tcpq) or use udpm://");
  return "tcpq://" + std::string(numeric.data()) + ":" + port;
}

void refuse_url(const std::string& url, const std::string& what) {
  throw BusError("LCM URL '" + url + "': " + what);
}

}  // namespace bridges
