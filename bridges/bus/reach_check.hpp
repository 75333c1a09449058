// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>

#include "bridges/bus/network_check.hpp"

namespace bridges {

/// Of the sockets in a table such as /proc/net/udp or /proc/net/tcp, those of a port that other machines can reach.
struct OpenSockets {
  int everywhere = 0;  ///< bound to 0.0.0.0
  int elsewhere = 0;   ///< bound to another address that is neither loopback nor multicast
};
/// `listening_only`: of TCP, those that wait for connections.
OpenSockets open_sockets(std::istream& table, int port, bool listening_only);

/// Whether other machines can reach the bus of this URL: by its ttl, by the addresses that sockets on its port are
/// bound to, by its server.  For `shoal doctor`.
Finding check_reach(const std::string& resolved_url);

}  // namespace bridges
