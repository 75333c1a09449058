// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/network_check.hpp"

#include <arpa/inet.h>
#include <dirent.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>

#include "bridges/base/forked_work.hpp"
#include "bridges/lcm/lcm_connection.hpp"
#include "bridges/lcm/lcm_listener.hpp"

namespace bridges {
namespace {

using Verdict = Finding::Verdict;

constexpr long desired_buffer_bytes = 4194304;
constexpr unsigned route_is_up = 1;  // RTF_UP of <linux/route.h>

struct Route {
  std::string interface;
  unsigned prefix_bits = 0;
};

/// Returns the most specific route to the group, as the kernel would choose it.
std::optional<Route> route_to(in_addr_t group) {
  std::ifstream table("/proc/net/route");
  std::string line;
  std::getline(table, line);
  std::optional<Route> best;
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::string interface, skip;
    in_addr_t destination = 0, mask = 0;
    unsigned flags = 0;
    // columns: interface destination gateway flags refcnt use metric mask; addresses in memory byte order
    fields >> interface >> std::hex >> destination >> skip >> flags >> skip >> skip >> skip >> mask;
    if (!fields || (flags & route_is_up) == 0 || (group & mask) != destination) continue;
    const auto bits = static_cast<unsigned>(__builtin_popcount(mask));
    if (!best || bits > best->prefix_bits) best = Route{interface, bits};
  }
  return best;
}

std::map<std::string, unsigned> interface_flags() {
  std::map<std::string, unsigned> flags;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return flags;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next)
    flags[entry->ifa_name] = entry->ifa_flags;
  freeifaddrs(list);
  return flags;
}

/// Returns commands that route multicast within this machine.
std::vector<std::string> loopback_commands(const std::map<std::string, unsigned>& flags) {
  std::vector<std::string> commands;
  const auto lo = flags.find("lo");
  const unsigned lo_flags = lo == flags.end() ? 0 : lo->second;
  if ((lo_flags & IFF_UP) == 0) commands.emplace_back("ip link set lo up");
  if ((lo_flags & IFF_MULTICAST) == 0) commands.emplace_back("ip link set lo multicast on");
  commands.emplace_back("ip route add 224.0.0.0/4 dev lo");
  return commands;
}

Finding check_route(const LcmEndpoint& endpoint) {
  Finding finding{"multicast route", Verdict::ok, "", {}};
  const auto flags = interface_flags();
  // Find the route to the multicast group.
  const auto route = route_to(inet_addr(endpoint.address.c_str()));
  if (!route) {
    finding.verdict = Verdict::bad;
    finding.text = "there is no route to the multicast group " + endpoint.address;
    finding.commands = loopback_commands(flags);
    return finding;
  }
  // Check the interface of the route.
  const auto found = flags.find(route->interface);
  const unsigned interface = found == flags.end() ? 0 : found->second;
  finding.text = endpoint.address + " goes over " + route->interface;
  if ((interface & IFF_UP) == 0) {
    finding.verdict = Verdict::bad;
    finding.text += ", which is down";
    finding.commands = {"ip link set " + route->interface + " up"};
  } else if ((interface & IFF_MULTICAST) == 0) {
    // Messages pass over lo without the flag, but some tools check it.
    finding.verdict = Verdict::warning;
    finding.text += ", which does not support multicast";
    finding.commands = {"ip link set " + route->interface + " multicast on"};
  }
  return finding;
}

long read_number(const std::string& path) {
  long value = -1;
  std::ifstream(path) >> value;
  return value;
}

Finding check_buffers() {
  Finding finding{"receive buffers", Verdict::ok, "", {}};
  const long maximum = read_number("/proc/sys/net/core/rmem_max");
  const long standard = read_number("/proc/sys/net/core/rmem_default");
  if (maximum < 0) {
    // Network namespaces of containers do not show it.
    finding.verdict = Verdict::warning;
    finding.text = "net.core.rmem_max cannot be read here; on the host it must be at least 4194304";
    return finding;
  }
  finding.text = "net.core.rmem_max is " + std::to_string(maximum);
  // Check the maximum size of a buffer.
  if (maximum < desired_buffer_bytes) {
    finding.verdict = Verdict::warning;
    finding.text += ": bursts of messages and images will be lost";
    finding.commands.emplace_back("sysctl -w net.core.rmem_max=4194304");
  }
  // Check the default size of a buffer.
  if (standard >= 0 && standard < desired_buffer_bytes) {
    finding.text += "; net.core.rmem_default is " + std::to_string(standard) +
                    ", so other LCM programs need ?recv_buf_size=4194304 in their URL";
    if (finding.verdict != Verdict::ok) finding.commands.emplace_back("sysctl -w net.core.rmem_default=4194304");
  }
  return finding;
}

/// Returns the identifiers of the UDP sockets bound to the port.
std::set<std::string> sockets_on_port(int port) {
  std::set<std::string> inodes;
  std::ifstream table("/proc/net/udp");
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::string slot, local, skip, inode;
    fields >> slot >> local;
    for (int i = 0; i < 7; ++i) fields >> skip;
    fields >> inode;
    const auto colon = local.find(':');
    if (!fields || colon == std::string::npos) continue;
    if (std::strtol(local.c_str() + colon + 1, nullptr, 16) == port) inodes.insert(inode);
  }
  return inodes;
}

bool holds_socket(const std::string& pid, const std::set<std::string>& inodes) {
  const std::string folder = "/proc/" + pid + "/fd";
  DIR* directory = opendir(folder.c_str());
  // Processes of other users cannot be read; their sockets stay without an owner.
  if (directory == nullptr) return false;
  bool found = false;
  while (const dirent* entry = readdir(directory)) {
    std::array<char, 64> target{};
    const auto length = readlink((folder + "/" + entry->d_name).c_str(), target.data(), target.size() - 1);
    if (length <= 0) continue;
    const std::string text(target.data(), static_cast<std::size_t>(length));
    if (text.starts_with("socket:[") && inodes.contains(text.substr(8, text.size() - 9))) found = true;
  }
  closedir(directory);
  return found;
}

/// Returns names such as "lcm-logger (4711)" of the accessible processes.
std::vector<std::string> owners_of(const std::set<std::string>& inodes) {
  std::vector<std::string> owners;
  DIR* directory = opendir("/proc");
  if (directory == nullptr) return owners;
  const std::string own = std::to_string(getpid());
  while (const dirent* entry = readdir(directory)) {
    const std::string pid = entry->d_name;
    if (pid == own || pid.find_first_not_of("0123456789") != std::string::npos || !holds_socket(pid, inodes)) continue;
    std::string name;
    std::getline(std::ifstream("/proc/" + pid + "/comm"), name);
    owners.push_back(name + " (" + pid + ")");
  }
  closedir(directory);
  return owners;
}

/// Returns the groups that other programs on this machine have joined, except `own`.
std::set<std::string> other_groups(const std::string& own) {
  std::set<std::string> groups;
  std::ifstream table("/proc/net/igmp");
  std::string line;
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::string word;
    if (line.empty() || line[0] != '\t' || !(fields >> word) || word.size() != 8) continue;
    const in_addr address{static_cast<in_addr_t>(std::strtoul(word.c_str(), nullptr, 16))};
    const std::string group = inet_ntoa(address);
    if (group != own && group != "224.0.0.1") groups.insert(group);
  }
  return groups;
}

Finding check_port(const LcmEndpoint& endpoint) {
  Finding finding{"UDP port " + std::to_string(endpoint.port), Verdict::ok, "no other program uses it", {}};
  const auto inodes = sockets_on_port(endpoint.port);
  if (inodes.empty()) return finding;
  finding.text = std::to_string(inodes.size()) + " sockets use it";
  std::string separator = ": ";
  for (const std::string& owner : owners_of(inodes)) {
    finding.text += separator + owner;
    separator = ", ";
  }
  finding.text += "; they and this simulator receive each other's messages";
  const auto groups = other_groups(endpoint.address);
  // liblcm 1.3 binds the port, not the group, so the kernel delivers all groups that any program on this machine has
  // joined.
  if (groups.empty()) return finding;
  finding.verdict = Verdict::warning;
  separator = ", and there are other multicast groups (";
  for (const std::string& group : groups) {
    finding.text += separator + group;
    separator = ", ";
  }
  finding.text += "): programs on liblcm 1.3 receive all groups of a port, so give every team its own port";
  return finding;
}

/// Runs the round trip in the child; returns 0 when a message came back.  Errors are written to stderr, which the
/// parent reads.
int round_trip(const std::string& url, std::chrono::milliseconds time_limit) {
  try {
    LcmListener receiver(url);
    // memq passes messages within one instance only.
    std::optional<LcmListener> own_sender;
    if (lcm_endpoint(receiver.url()).kind != "memq") own_sender.emplace(url);
    LcmListener& sender = own_sender ? *own_sender : receiver;
    const std::string channel = "shoal.doctor." + std::to_string(getpid());
    receiver.listen(channel);
    const std::array<std::byte, 8> payload{};
    const auto deadline = std::chrono::steady_clock::now() + time_limit;
    while (std::chrono::steady_clock::now() < deadline) {
      sender.publish(channel, payload);
      if (receiver.next(std::chrono::milliseconds(100))) return 0;
    }
    std::fputs("a test message was not received\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  return 1;
}

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

Finding check_round_trip(const std::string& url, std::chrono::milliseconds time_limit) {
  Finding finding{"round trip", Verdict::bad, "", {}};
  ForkedWork done;
  try {
    const auto test = [&](int to) {
      dup2(to, STDERR_FILENO);
      dup2(to, STDOUT_FILENO);
      return round_trip(url, time_limit);
    };
    done = run_forked(test, std::chrono::steady_clock::now() + time_limit);
  } catch (const std::system_error& error) {
    const bool no_file = error.code().value() == EMFILE || error.code().value() == ENFILE;
    finding.text = no_file ? "no file descriptor is available for the test" : "cannot start a process for the test";
    return finding;
  }
  // Interpret the result.
  if (!done.output) {
    finding.text = "no test message was received within " + std::to_string(time_limit.count()) +
                   " ms; a firewall may drop multicast on UDP";
    finding.commands = {"iptables -I INPUT -p udp -d 224.0.0.0/4 -j ACCEPT",
                        "iptables -I OUTPUT -p udp -d 224.0.0.0/4 -j ACCEPT"};
  } else if (WIFEXITED(done.status) && WEXITSTATUS(done.status) == 0) {
    finding.verdict = Verdict::ok;
    finding.text = "a test message was received";
  } else if (WIFSIGNALED(done.status)) {
    finding.text =
        "liblcm stopped with signal " + std::to_string(WTERMSIG(done.status)) + ": " + last_line(*done.output);
  } else {
    finding.text = last_line(*done.output);
  }
  return finding;
}

}  // namespace

std::vector<Finding> check_network(const std::string& url, std::chrono::milliseconds time_limit) {
  std::string resolved;
  LcmEndpoint endpoint;
  try {
    resolved = resolve_lcm_url(url);
    endpoint = lcm_endpoint(resolved);
  } catch (const BusError& error) {
    return {{"LCM URL", Verdict::bad, error.what(), {}}};
  }
  std::vector<Finding> findings{{"LCM URL", Verdict::ok, resolved, {}}};
  // Run the checks that apply to the kind of bus.
  if (endpoint.kind == "udpm") {
    findings.push_back(check_route(endpoint));
    findings.push_back(check_buffers());
    findings.push_back(check_port(endpoint));
  }
  if (endpoint.kind != "memq") findings.push_back(check_reach(resolved));
  findings.push_back(check_round_trip(resolved, time_limit));
  // Without a route the remedy is known: repeat it at the symptom.
  for (const Finding& finding : findings)
    if (finding.name == "multicast route" && finding.verdict == Verdict::bad && findings.back().verdict == Verdict::bad)
      findings.back().commands = finding.commands;
  return findings;
}

}  // namespace bridges
