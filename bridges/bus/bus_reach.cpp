// SPDX-License-Identifier: BSD-3-Clause
#include <arpa/inet.h>

#include <cstdlib>
#include <fstream>
#include <istream>
#include <sstream>

#include "bridges/bus/network_check.hpp"
#include "bridges/lcm/lcm_connection.hpp"
#include "bridges/lcm/lcm_url.hpp"

namespace bridges {

bool leaves_machine(const std::string& resolved_url) {
  const LcmEndpoint endpoint = lcm_endpoint(resolved_url);
  return endpoint.kind != "memq" && (endpoint.kind != "udpm" || endpoint.ttl > 0);
}

namespace {

constexpr const char* key_needed =
    "; a run on this bus is controlled with its key only, see docs/guides/access_control.md";
constexpr const char* listening_state = "0A";  // TCP_LISTEN of the kernel

Finding check_server(const LcmEndpoint& endpoint) {
  Finding finding{"reach", Finding::Verdict::warning, "", {}};
  const std::string port = std::to_string(endpoint.port);
  std::ifstream table("/proc/net/tcp"), table_6("/proc/net/tcp6");
  const OpenSockets sockets = open_sockets(table, endpoint.port, true);
  // An address of 128 zeros also accepts connections over IPv4, as Java servers do.
  std::stringstream ports_6;
  ports_6 << table_6.rdbuf();
  char local[16];
  std::snprintf(local, sizeof local, ":%04X ", static_cast<unsigned>(endpoint.port));
  const bool everywhere_6 = ports_6.str().find(std::string(32, '0') + local) != std::string::npos;
  if (sockets.everywhere + sockets.elsewhere > 0 || everywhere_6) {
    finding.text = "a server on TCP port " + port + " of this machine accepts connections from other machines";
    finding.commands = {"iptables -I INPUT -p tcp --dport " + port + " -m addrtype ! --src-type LOCAL -j DROP"};
  } else {
    finding.text = "what reaches the server " + endpoint.address + ":" + port + " reaches this bus";
  }
  finding.text += key_needed;
  return finding;
}

}  // namespace

OpenSockets open_sockets(std::istream& table, int port, bool listening_only) {
  OpenSockets sockets;
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::string slot, local, remote, state;
    fields >> slot >> local >> remote >> state;
    const auto colon = local.find(':');
    if (!fields || colon == std::string::npos) continue;
    if (std::strtol(local.c_str() + colon + 1, nullptr, 16) != port) continue;
    if (listening_only && state != listening_state) continue;
    // Printed from memory, that is in network byte order.
    const auto address = ntohl(static_cast<in_addr_t>(std::strtoul(local.c_str(), nullptr, 16)));
    const bool loopback = address >> 24 == 127, multicast = address >> 28 == 14;
    if (address == 0)
      ++sockets.everywhere;
    else if (!loopback && !multicast)
      ++sockets.elsewhere;
  }
  return sockets;
}

Finding check_reach(const std::string& resolved_url) {
  const LcmEndpoint endpoint = lcm_endpoint(resolved_url);
  Finding finding{"reach", Finding::Verdict::ok, "messages of this bus stay on this machine", {}};
  if (endpoint.kind == "memq") return finding;
  if (endpoint.kind == "tcpq") return check_server(endpoint);
  // Check the ttl of the URL.
  if (leaves_machine(resolved_url)) {
    finding.verdict = Finding::Verdict::warning;
    finding.text = "its ttl is above 0: messages of this bus leave this machine, and other machines can send to it" +
                   std::string(key_needed);
    return finding;
  }
  // Check the addresses of open sockets on the port.
  std::ifstream table("/proc/net/udp");
  const OpenSockets sockets = open_sockets(table, endpoint.port, false);
  const int open = sockets.everywhere + sockets.elsewhere;
  if (open == 0) return finding;
  const std::string port = std::to_string(endpoint.port);
  finding.verdict = Finding::Verdict::warning;
  finding.text += ", but UDP port " + port + " is open to the network: " + std::to_string(open) +
                  (open == 1 ? " socket takes" : " sockets take") +
                  " datagrams that other machines send to it; shoal drops those, other LCM programs do not";
  finding.commands = {"iptables -I INPUT -p udp --dport " + port + " -m addrtype ! --src-type LOCAL -j DROP"};
  return finding;
}

}  // namespace bridges
