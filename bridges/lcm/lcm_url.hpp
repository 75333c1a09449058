// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "bridges/base/bus_error.hpp"

namespace bridges {

/// ttl=0: messages stay on this machine.  The kernel's default buffer holds some 160 small messages only.
inline constexpr const char* default_lcm_url = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";
/// LCM 1.3.1 never delivers larger messages.
inline constexpr std::size_t max_lcm_message_bytes = std::size_t{16} << 20;

/// liblcm sends itself messages on it when it starts.
inline constexpr const char* self_test_channel = "LCM_SELF_TEST";

/// The URL that is used: `url`, or LCM_DEFAULT_URL, or the default; recv_buf_size is added to a udpm URL
/// without. Throws BusError on a URL that LCM would misunderstand.
std::string resolve_lcm_url(const std::string& url);

/// A multicast address and port, "239.255.76.67" and 7667.  Host and port of the server for tcpq.
struct LcmEndpoint {
  std::string kind;  ///< "udpm", "tcpq", "memq"
  std::string address;
  int port = 0;
  int ttl = 0;             ///< udpm; 0: nothing leaves this machine
  int recv_buf_bytes = 0;  ///< udpm; 0: what the kernel gives
};
LcmEndpoint lcm_endpoint(const std::string& resolved_url);

/// Throws BusError that names the URL.
[[noreturn]] void refuse_url(const std::string& url, const std::string& what);

/// Throws BusError when no LCM server answers there: liblcm would retry forever, and then abort.
void require_tcp_server(const std::string& url, const LcmEndpoint& endpoint);

}  // namespace bridges
