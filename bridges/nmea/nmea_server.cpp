// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/nmea_server.hpp"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "bridges/base/bus_error.hpp"
#include "sim/base/number.hpp"

namespace bridges::nmea {

namespace {

using Clock = std::chrono::steady_clock;

std::string text_of(const sockaddr* address, socklen_t size) {
  char host[NI_MAXHOST], port[NI_MAXSERV];
  if (getnameinfo(address, size, host, sizeof host, port, sizeof port, NI_NUMERICHOST | NI_NUMERICSERV) != 0)
    return "?";
  const bool has_colons = std::strchr(host, ':') != nullptr;
  return (has_colons ? "[" + std::string(host) + "]" : host) + ":" + port;
}

std::string text_of(const Endpoint& endpoint) {
  return endpoint.host + ":" + std::to_string(endpoint.port);
}

/// Opens a socket for the first address of a host for which `use` succeeds.  Throws BusError.
template <class Use>
FileDescriptor open_socket(const Endpoint& endpoint, int type, const char* what, const Use& use) {
  addrinfo hints{};
  hints.ai_socktype = type;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const std::string fault = std::string("NMEA: cannot ") + what + " " + text_of(endpoint) + ": ";
  if (const int error = getaddrinfo(endpoint.host.c_str(), std::to_string(endpoint.port).c_str(), &hints, &found))
    throw BusError(fault + gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  int error = EADDRNOTAVAIL;
  for (const addrinfo* address = found; address != nullptr; address = address->ai_next) {
    FileDescriptor socket(::socket(address->ai_family, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (socket.number() >= 0 && use(socket.number(), *address)) return socket;
    error = errno;
  }
  throw BusError(fault + std::strerror(error));
}

bool listen_at(int socket, const addrinfo& address) {
  const int on = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);  // a port of connections that have just ended
  return bind(socket, address.ai_addr, address.ai_addrlen) == 0 && listen(socket, 16) == 0;
}

bool connect_to(int socket, const addrinfo& address) {
  return connect(socket, address.ai_addr, address.ai_addrlen) == 0;
}

std::uint16_t port_of(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  char port[NI_MAXSERV] = "";
  auto* any = reinterpret_cast<sockaddr*>(&address);
  if (getsockname(socket, any, &size) == 0) getnameinfo(any, size, nullptr, 0, port, sizeof port, NI_NUMERICSERV);
  return sim::exact_number<std::uint16_t>(port).value_or(0);
}

bool is_later() {
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

}  // namespace

Endpoint read_endpoint(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const auto port =
      colon == std::string::npos ? std::nullopt : sim::exact_number<std::uint16_t>(text.substr(colon + 1));
  std::string host = text.substr(0, colon);
  const bool in_brackets = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (in_brackets) host = host.substr(1, host.size() - 2);
  if (!port || host.empty() || (!in_brackets && host.find_first_of(":[]") != std::string::npos))
    throw std::invalid_argument("an address must be HOST:PORT, such as 127.0.0.1:10110 or [::1]:10110, got '" + text +
                                "'");
  return {host, *port};
}

struct NmeaServer::Client {
  FileDescriptor socket;
  std::string name;
  std::string waiting;  ///< bytes to send
  sim::NmeaLines lines;
  Clock::time_point second{};  ///< start of the second in which these were received:
  std::size_t bytes_in_second = 0;
  std::string end = {};  ///< why it is to be closed; empty: it stays
};

NmeaServer::NmeaServer(Options options) : options_(std::move(options)) {
  if (options_.listen) {
    listener_ = open_socket(*options_.listen, SOCK_STREAM, "listen at", listen_at);
    port_ = port_of(listener_.number());
  }
  if (options_.udp) udp_ = open_socket(*options_.udp, SOCK_DGRAM, "send to", connect_to);
  thread_ = std::thread([this] { run(); });
}

NmeaServer::~NmeaServer() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.set();
  thread_.join();
}

void NmeaServer::send(const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    for (const std::string& line : lines) to_send_.push_back(line + "\r\n");
  }
  wake_.set();
}

std::vector<NmeaServer::Line> NmeaServer::take_lines() {
  const std::lock_guard lock(mutex_);
  return std::exchange(received_, {});
}

void NmeaServer::run() {
  while (true) {
    std::vector<pollfd> sockets{{wake_.fd(), POLLIN, 0}, {listener_.number(), POLLIN, 0}, {udp_.number(), POLLIN, 0}};
    for (const Client& client : clients_)
      sockets.push_back(
          {client.socket.number(), static_cast<short>(client.waiting.empty() ? POLLIN : POLLIN | POLLOUT), 0});
    if (poll(sockets.data(), sockets.size(), -1) < 0 && errno != EINTR) return;  // a negative descriptor is ignored
    {
      const std::lock_guard lock(mutex_);
      if (stop_) return;
    }
    std::size_t at = 3;
    for (Client& client : clients_) {
      const short events = sockets[at++].revents;
      if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) client.end = receive(client);
      if (client.end.empty() && (events & POLLOUT) != 0) client.end = flush(client);
    }
    if ((sockets[2].revents & (POLLIN | POLLERR)) != 0) receive_datagrams();
    if ((sockets[0].revents & POLLIN) != 0) distribute();
    clients_.remove_if([&](const Client& client) {
      if (client.end.empty()) return false;
      if (options_.log) options_.log(client.name + " " + client.end);
      return true;
    });
    if ((sockets[1].revents & POLLIN) != 0) accept_client();
  }
}

void NmeaServer::accept_client() {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  auto* any = reinterpret_cast<sockaddr*>(&address);
  FileDescriptor socket(accept4(listener_.number(), any, &size, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (socket.number() < 0) {
    if (!is_later()) poll(nullptr, 0, 100);  // no descriptor is free: the client keeps waiting, but not in a busy loop
    return;
  }
  const std::string name = text_of(any, size);
  const bool full = clients_.size() >= max_clients;
  if (options_.log)
    options_.log(name + (full ? " is refused: there are " + std::to_string(max_clients) + " clients" : " connected"));
  if (!full) clients_.push_back({std::move(socket), name, {}, {}, Clock::now()});
}

std::string NmeaServer::receive(Client& client) {
  std::array<std::byte, 4096> bytes;
  const ssize_t size = recv(client.socket.number(), bytes.data(), bytes.size(), 0);
  if (size == 0) return "disconnected";
  if (size < 0) return is_later() ? "" : std::string("is lost: ") + std::strerror(errno);
  if (Clock::now() - client.second > std::chrono::seconds(1)) {
    client.second = Clock::now();
    client.bytes_in_second = 0;
  }
  client.bytes_in_second += static_cast<std::size_t>(size);
  if (client.bytes_in_second > max_bytes_per_s)
    return "is cut: it sent more than " + std::to_string(max_bytes_per_s) + " bytes in a second";
  keep(client.name, client.lines.add(std::span(bytes.data(), static_cast<std::size_t>(size))));
  return {};
}

std::string NmeaServer::flush(Client& client) {
  const ssize_t size = ::send(client.socket.number(), client.waiting.data(), client.waiting.size(), MSG_NOSIGNAL);
  if (size < 0) return is_later() ? "" : std::string("is lost: ") + std::strerror(errno);
  client.waiting.erase(0, static_cast<std::size_t>(size));
  return {};
}

void NmeaServer::receive_datagrams() {
  std::array<std::byte, 4096> bytes;
  // A bounded number, so that a flood does not keep the others waiting.  An error is that of a datagram sent before.
  for (int i = 0; i < 16; ++i) {
    const ssize_t size = recv(udp_.number(), bytes.data(), bytes.size(), 0);
    if (size < 0) return;
    sim::NmeaLines lines;
    const std::byte end{'\n'};
    auto all = lines.add(std::span(bytes.data(), static_cast<std::size_t>(size)));
    for (auto& line : lines.add(std::span(&end, 1))) all.push_back(std::move(line));
    keep(text_of(*options_.udp), std::move(all));
  }
}

void NmeaServer::keep(const std::string& from, std::vector<sim::NmeaLines::Line> lines) {
  const std::lock_guard lock(mutex_);
  for (sim::NmeaLines::Line& line : lines) {
    if (received_.size() >= max_lines) received_.erase(received_.begin());
    received_.push_back({from, std::move(line.text)});
  }
}

void NmeaServer::distribute() {
  wake_.clear();
  std::vector<std::string> lines;
  {
    const std::lock_guard lock(mutex_);
    lines.swap(to_send_);
  }
  for (const std::string& line : lines) {
    if (udp_.number() >= 0) ::send(udp_.number(), line.data(), line.size(), MSG_NOSIGNAL);
    for (Client& client : clients_)
      if (client.end.empty()) client.waiting += line;
  }
  for (Client& client : clients_) {
    if (client.end.empty()) client.end = flush(client);
    if (client.end.empty() && client.waiting.size() > max_waiting_bytes)
      client.end = "is cut: it does not take what it is sent";
  }
}

}  // namespace bridges::nmea
