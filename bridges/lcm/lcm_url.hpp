// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "bridges/base/bus_error.hpp"

namespace bridges {

/// Default URL.  ttl=0: messages stay on this machine.  The larger buffer is needed because the default kernel buffer
/// holds only about 160 small messages.
inline constexpr const char* default_lcm_url = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";
/// Maximum size of a message that LCM 1.3.1 delivers.
inline constexpr std::size_t max_lcm_message_bytes = std::size_t{16} << 20;

/// Channel of the self test of liblcm at its start.
inline constexpr const char* self_test_channel = "LCM_SELF_TEST";

/// Returns the effective URL: `url`, or LCM_DEFAULT_URL, or the default; recv_buf_size is added to a udpm URL without
/// it.  Throws BusError for a URL that LCM would misinterpret.
std::string resolve_lcm_url(const std::string& url);

/// Endpoint of a URL: multicast address and port, "239.255.76.67" and 7667; for tcpq host and port of the server.
struct LcmEndpoint {
  std::string kind;  ///< "udpm", "tcpq", "memq"
  std::string address;
  int port = 0;
  int ttl = 0;             ///< udpm; 0: local to this machine
  int recv_buf_bytes = 0;  ///< udpm; 0: kernel default
};
LcmEndpoint lcm_endpoint(const std::string& resolved_url);

/// Throws BusError with the URL.
[[noreturn]] void refuse_url(const std::string& url, const std::string& what);

/// Returns the URL with the numeric address of its host, because liblcm 1.3.1 takes any name for this machine.  Throws
/// BusError when no LCM server answers there: liblcm would retry forever, and then abort.
std::string require_tcp_server(const std::string& url, const LcmEndpoint& endpoint);

}  // namespace bridges
