// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <iosfwd>
#include <string>
#include <vector>

namespace bridges {

/// Result of one check of `shoal doctor`.
struct Finding {
  enum class Verdict { ok, warning, bad };
  std::string name;  ///< "multicast route"
  Verdict verdict = Verdict::ok;
  std::string text;
  std::vector<std::string> commands;  ///< remedy: commands to execute as root, in this order
};

/// Checks whether LCM works on this machine with this URL (empty: the one that a run would use), and finds the reason
/// if not.  Opens no LCM in this process: the round trip is made in a child process, because liblcm may block or abort.
/// Only for a program without other threads.
std::vector<Finding> check_network(const std::string& url = {},
                                   std::chrono::milliseconds time_limit = std::chrono::milliseconds(3000));

/// Checks what of this URL reaches another machine: its name, the route, a tcpq server on it (port 7700, or that of the
/// URL), and multicast with a ttl above 0, for which the other machine must make the same check at the same time or run
/// something on the bus.  The last finding sums up.  Opens no LCM; `time_limit`: of each part.
std::vector<Finding> check_peer(const std::string& host, const std::string& url = {},
                                std::chrono::milliseconds time_limit = std::chrono::milliseconds(3000));

/// Returns whether messages on this bus may come from or go to other machines: for multicast with a ttl above 0, and
/// for tcpq, whose server may be reachable from anywhere.  Returns true when in doubt.  `resolved_url`: result of
/// resolve_lcm_url().  Programs that forward messages from one bus to another are not detected.
bool leaves_machine(const std::string& resolved_url);

/// Numbers of sockets on a port that other machines can reach, from a table such as /proc/net/udp or /proc/net/tcp.
struct OpenSockets {
  int everywhere = 0;  ///< bound to 0.0.0.0
  int elsewhere = 0;   ///< bound to another address that is neither loopback nor multicast
};
/// Counts the sockets of a port in a table.  `listening_only`: only TCP sockets that wait for connections.
OpenSockets open_sockets(std::istream& table, int port, bool listening_only);

/// Checks whether other machines can reach the bus of this URL, from its ttl, the addresses to which sockets on its
/// port are bound, and its server.  For `shoal doctor`.
Finding check_reach(const std::string& resolved_url);

}  // namespace bridges
