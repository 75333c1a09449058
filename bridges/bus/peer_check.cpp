// SPDX-License-Identifier: BSD-3-Clause
#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/bus/network_check.hpp"
#include "bridges/lcm/lcm_url.hpp"
#include "sim/base/number.hpp"

namespace bridges {
namespace {

using Verdict = Finding::Verdict;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int default_tcpq_port = 7700;

std::string text_of(const in_addr& address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

sockaddr_in address_of(const in_addr& host, int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr = host;
  address.sin_port = htons(static_cast<in_port_t>(port));
  return address;
}

std::string number_bytes(std::uint32_t value) {
  value = htonl(value);
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

Finding resolve(const std::string& host, std::optional<in_addr>& address) {
  Finding finding{"peer", Verdict::bad, "", {}};
  addrinfo hints{};
  hints.ai_family = AF_INET;
  addrinfo* list = nullptr;
  if (const int error = getaddrinfo(host.c_str(), nullptr, &hints, &list); error != 0) {
    finding.text = "'" + host + "' is not known here: " + gai_strerror(error) + "; give its IPv4 address";
    return finding;
  }
  address = reinterpret_cast<const sockaddr_in*>(list->ai_addr)->sin_addr;
  freeaddrinfo(list);
  finding.verdict = Verdict::ok;
  finding.text = host + (host == text_of(*address) ? " is an address" : " is " + text_of(*address));
  return finding;
}

/// Finds the address of this machine that the other one sees.
Finding check_route(const in_addr& peer, in_addr& own) {
  const FileDescriptor probe(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const sockaddr_in to = address_of(peer, default_tcpq_port);
  sockaddr_in from{};
  socklen_t size = sizeof from;
  // Sends nothing: the kernel only chooses the route.
  if (connect(probe.number(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0 ||
      getsockname(probe.number(), reinterpret_cast<sockaddr*>(&from), &size) != 0)
    return {"route", Verdict::bad, "there is no route to " + text_of(peer) + ": " + std::strerror(errno), {}};
  own = from.sin_addr;
  return {"route", Verdict::ok, "this machine is " + text_of(own) + " for it", {}};
}

/// Connection that gives up after a time.
FileDescriptor connect_to(const sockaddr_in& to, milliseconds limit, std::string& error) {
  FileDescriptor fd(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const timeval time{limit.count() / 1000, limit.count() % 1000 * 1000};
  const int yes = 1;
  setsockopt(fd.number(), SOL_SOCKET, SO_SNDTIMEO, &time, sizeof time);  // for connect() too
  setsockopt(fd.number(), SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
  setsockopt(fd.number(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  if (connect(fd.number(), reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) return fd;
  error = std::strerror(errno == EINPROGRESS ? ETIMEDOUT : errno);
  return FileDescriptor();
}

bool send_all(int fd, const std::string& bytes) {
  return ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

bool receive(int fd, const std::string& expected) {
  std::string bytes(expected.size(), '\0');
  return recv(fd, bytes.data(), bytes.size(), MSG_WAITALL) == static_cast<ssize_t>(bytes.size()) && bytes == expected;
}

/// Sends itself a message by the server of the peer.
Finding check_tcpq(const in_addr& peer, int port, milliseconds limit) {
  const std::string where = text_of(peer) + ":" + std::to_string(port);
  Finding finding{"tcpq server", Verdict::warning, "", {}};
  std::string error;
  const FileDescriptor fd = connect_to(address_of(peer, port), limit, error);
  if (fd.number() < 0) {
    finding.text = "none at " + where + " (" + error + "); start one there: shoal tcpq --host " + text_of(peer) +
                   (port == default_tcpq_port ? "" : " --port " + std::to_string(port));
    return finding;
  }
  const std::string version = number_bytes(0x0100);
  const std::string channel = "shoal.doctor." + std::to_string(getpid());
  const std::string name = number_bytes(static_cast<std::uint32_t>(channel.size())) + channel;
  const std::string message = number_bytes(1) + name + number_bytes(8) + "12345678";
  if (!send_all(fd.number(), number_bytes(0x287617fb) + version + number_bytes(2) + name) ||
      !receive(fd.number(), number_bytes(0x287617fa) + version)) {
    finding.text = "what listens at " + where + " does not speak tcpq";
    return finding;
  }
  const auto begin = Clock::now();
  if (!send_all(fd.number(), message) || !receive(fd.number(), message)) {
    finding.text = where + " answers, but does not pass messages on";
    return finding;
  }
  const double time_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  finding.verdict = Verdict::ok;
  finding.text = where + " passes messages on, round trip " + sim::shortest_text(sim::rounded_to(time_ms, 2)) + " ms";
  return finding;
}

/// Socket that receives what is sent to the group.
FileDescriptor join(const LcmEndpoint& group) {
  FileDescriptor fd(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const int yes = 1;
  ip_mreq request{};
  inet_pton(AF_INET, group.address.c_str(), &request.imr_multiaddr);
  const sockaddr_in address = address_of(request.imr_multiaddr, group.port);
  const auto ttl = static_cast<unsigned char>(group.ttl);
  setsockopt(fd.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  setsockopt(fd.number(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  const bool joined = bind(fd.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
                      setsockopt(fd.number(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) == 0;
  return joined ? std::move(fd) : FileDescriptor();
}

/// Announces this machine until messages of the other one arrive, and say that those of this one do.
Finding check_multicast(const in_addr& peer, const in_addr& own, const LcmEndpoint& group, milliseconds limit) {
  Finding finding{"multicast", Verdict::warning, "", {}};
  if (group.ttl == 0) {
    finding.text = "the URL has ttl=0: its messages do not leave this machine; use ?ttl=1 on both";
    return finding;
  }
  const FileDescriptor fd = join(group);
  if (fd.number() < 0) {
    finding.text = "cannot join " + group.address + ": " + std::strerror(errno);
    return finding;
  }
  in_addr to{};
  inet_pton(AF_INET, group.address.c_str(), &to);
  const sockaddr_in address = address_of(to, group.port);
  // A message of LCM, so that other programs on the bus are not disturbed; its payload is whose messages this machine
  // receives.
  const std::string head = number_bytes(0x4c433032) + number_bytes(0) + "shoal.doctor.peer" + '\0';
  int received = 0;
  bool both = false;
  const auto end = Clock::now() + limit;
  auto next = Clock::now();
  while (Clock::now() < end && !both) {
    if (Clock::now() >= next) {
      const std::string message = head + (received > 0 ? text_of(peer) : "");
      sendto(fd.number(), message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&address),
             sizeof address);
      next += milliseconds(100);
    }
    pollfd waiting{fd.number(), POLLIN, 0};
    if (poll(&waiting, 1, 50) != 1) continue;
    std::array<char, 65536> bytes;
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got = recvfrom(fd.number(), bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (got <= 0 || from.sin_addr.s_addr != peer.s_addr) continue;
    ++received;
    both = std::string_view(bytes.data(), static_cast<std::size_t>(got)) == head + text_of(own);
  }
  const std::string bus = group.address + ":" + std::to_string(group.port);
  if (both) {
    // The other machine waits for the same answer
    const std::string message = head + text_of(peer);
    sendto(fd.number(), message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    finding.verdict = Verdict::ok;
    finding.text = "both machines receive each other on " + bus;
  } else if (received > 0) {
    finding.verdict = Verdict::ok;
    finding.text = "this machine receives " + text_of(peer) + " on " + bus + "; run 'shoal doctor --peer " +
                   text_of(own) + "' there at the same time to know the other way";
  } else {
    finding.text = "nothing of " + text_of(peer) + " arrived on " + bus + "; run 'shoal doctor --peer " + text_of(own) +
                   "' there at the same time, or use tcpq";
  }
  return finding;
}

}  // namespace

std::vector<Finding> check_peer(const std::string& host, const std::string& url, milliseconds time_limit) {
  LcmEndpoint endpoint;
  try {
    endpoint = lcm_endpoint(resolve_lcm_url(url));
  } catch (const BusError& error) {
    return {{"LCM URL", Verdict::bad, error.what(), {}}};
  }
  std::optional<in_addr> peer;
  std::vector<Finding> findings{resolve(host, peer)};
  if (!peer) return findings;
  in_addr own{};
  findings.push_back(check_route(*peer, own));
  if (findings.back().verdict == Verdict::bad) return findings;
  const bool is_tcp = endpoint.kind == "tcpq";
  findings.push_back(check_tcpq(*peer, is_tcp ? endpoint.port : default_tcpq_port, time_limit));
  bool connected = findings.back().verdict == Verdict::ok;
  if (endpoint.kind == "udpm") {
    findings.push_back(check_multicast(*peer, own, endpoint, time_limit));
    connected = connected || findings.back().verdict == Verdict::ok;
  }
  findings.push_back(connected ? Finding{"connection", Verdict::ok, "a run can be shared with " + host, {}}
                               : Finding{"connection", Verdict::bad, "no bus reaches " + host, {}});
  return findings;
}

}  // namespace bridges
