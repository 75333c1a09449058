// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/tcpq_server.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <regex.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "bridges/lcm/lcm_url.hpp"

namespace bridges {
namespace {

// Wire format of tcpq in liblcm 1.3: all numbers are 32 bits, big-endian.  Both sides begin with these and the version.
constexpr std::uint32_t magic_of_server = 0x287617fa, magic_of_client = 0x287617fb, protocol_version = 0x0100;
constexpr std::size_t hello_bytes = 8;
constexpr std::size_t max_channel_bytes = 63;
constexpr std::chrono::seconds hello_time{10};

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return ntohl(value);
}

void append_number(std::string& bytes, std::size_t value) {
  const std::uint32_t number = htonl(static_cast<std::uint32_t>(value));
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string hello_of_server() {
  std::string hello;
  append_number(hello, magic_of_server);
  append_number(hello, protocol_version);
  return hello;
}

std::string size_error(const char* what, std::size_t size, std::size_t limit) {
  return std::string(what) + " must have at most " + std::to_string(limit) + " bytes, got " + std::to_string(size);
}

std::string name_of(const sockaddr_in& address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &address.sin_addr, text.data(), text.size());
  return std::string(text.data()) + ":" + std::to_string(ntohs(address.sin_port));
}

}  // namespace

// --- Patterns

struct ChannelPatterns::Compiled {
  explicit Compiled(const std::string& pattern)
      : error(regcomp(&regex, ("^(" + pattern + ")$").c_str(), REG_EXTENDED | REG_NOSUB)) {}
  ~Compiled() {
    if (error == 0) regfree(&regex);
  }
  Compiled(const Compiled&) = delete;
  Compiled& operator=(const Compiled&) = delete;

  regex_t regex{};
  const int error;
};

std::optional<std::string> ChannelPatterns::add(std::string_view pattern) {
  if (pattern.size() > max_pattern_bytes) return size_error("a pattern", pattern.size(), max_pattern_bytes);
  if (patterns_.size() >= max_patterns)
    return "a client has at most " + std::to_string(max_patterns) + " subscriptions";
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const bool back_reference =
        pattern[i] == '\\' && i + 1 < pattern.size() && pattern[i + 1] >= '1' && pattern[i + 1] <= '9';
    if (pattern[i] == '\0' || pattern[i] == '{' || back_reference)
      return "a pattern must have no '{', no back reference and no zero byte";
    if (pattern[i] == '\\') ++i;
  }
  auto compiled = std::make_shared<const Compiled>(std::string(pattern));
  if (compiled->error != 0) return "a pattern is not an extended regular expression";
  patterns_.emplace(std::string(pattern), std::move(compiled));
  known_.clear();
  return std::nullopt;
}

bool ChannelPatterns::remove(std::string_view pattern) {
  const auto found = patterns_.find(pattern);
  if (found == patterns_.end()) return false;
  patterns_.erase(found);
  known_.clear();
  return true;
}

bool ChannelPatterns::matches(const std::string& channel) {
  constexpr std::size_t max_known = 10'000;
  if (const auto known = known_.find(channel); known != known_.end()) return known->second;
  if (known_.size() >= max_known) known_.clear();
  const bool found = std::any_of(patterns_.begin(), patterns_.end(), [&](const auto& each) {
    return regexec(&each.second->regex, channel.c_str(), 0, nullptr, 0) == 0;
  });
  return known_[channel] = found;
}

// --- Requests

std::optional<std::string> read_tcpq_request(std::string_view bytes, std::optional<TcpqRequest>& request) {
  constexpr std::size_t head = 8;
  request.reset();
  if (bytes.size() < head) return std::nullopt;
  const std::uint32_t kind = number_at(bytes, 0);
  const std::size_t name_size = number_at(bytes, 4);
  if (kind < 1 || kind > 3) return "unknown request " + std::to_string(kind);
  const bool publishes = kind == 1;
  const std::size_t limit = publishes ? max_channel_bytes : ChannelPatterns::max_pattern_bytes;
  if (name_size > limit) return size_error(publishes ? "a channel" : "a pattern", name_size, limit);
  std::size_t size = head + name_size;
  std::size_t payload_size = 0;
  if (publishes) {
    if (bytes.size() < size + 4) return std::nullopt;
    payload_size = number_at(bytes, size);
    if (payload_size > max_lcm_message_bytes) return size_error("a message", payload_size, max_lcm_message_bytes);
    size += 4 + payload_size;
  }
  if (bytes.size() < size) return std::nullopt;
  request = {static_cast<TcpqRequest::Kind>(kind), bytes.substr(head, name_size),
             bytes.substr(size - payload_size, payload_size), size};
  return std::nullopt;
}

// --- Server

struct TcpqServer::Client {
  Client(int fd, std::string from) : socket(fd), name(std::move(from)) {}

  FileDescriptor socket;
  std::string name;
  Clock::time_point since = Clock::now();
  bool greeted = false, left = false;
  ChannelPatterns patterns;
  std::string input;
  std::deque<std::shared_ptr<const std::string>> output;
  std::size_t sent = 0;     // bytes of the first output
  std::size_t waiting = 0;  // bytes
};

TcpqServer::TcpqServer(const Options& options, Report report)
    : options_(options),
      report_(std::move(report)),
      listener_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)),
      wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  const std::string where = options.host + ":" + std::to_string(options.port);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(options.port);
  if (inet_pton(AF_INET, options.host.c_str(), &address.sin_addr) != 1)
    throw BusError("tcpq server: '" + options.host + "' is not a numeric IPv4 address");
  const int yes = 1;
  socklen_t size = sizeof address;
  if (listener_.number() < 0 || wake_.number() < 0 ||
      setsockopt(listener_.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0 ||
      bind(listener_.number(), reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      listen(listener_.number(), SOMAXCONN) != 0 ||
      getsockname(listener_.number(), reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw BusError("tcpq server: cannot listen on " + where + ": " + std::strerror(errno));
  port_ = ntohs(address.sin_port);
}

TcpqServer::~TcpqServer() = default;

void TcpqServer::stop() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(wake_.number(), &one, sizeof one);
}

void TcpqServer::run() {
  std::vector<pollfd> polled;
  for (;;) {
    polled = {{wake_.number(), POLLIN, 0}, {listener_.number(), POLLIN, 0}};
    for (const Client& client : clients_)
      polled.push_back({client.socket.number(), static_cast<short>(POLLIN | (client.output.empty() ? 0 : POLLOUT)), 0});
    if (poll(polled.data(), polled.size(), 1000) < 0 && errno != EINTR)
      throw BusError(std::string("tcpq server: ") + std::strerror(errno));
    if (polled[0].revents != 0) return;
    // Clients that come now are after those that were polled.
    auto client = clients_.begin();
    for (std::size_t i = 2; i < polled.size(); ++i, ++client) {
      if ((polled[i].revents & POLLOUT) != 0) send(*client);
      if ((polled[i].revents & (POLLIN | POLLERR | POLLHUP)) != 0) read(*client);
    }
    if ((polled[1].revents & POLLIN) != 0) accept_clients();
    cut_silent_clients(Clock::now());
    clients_.remove_if([](const Client& each) { return each.left; });
  }
}

void TcpqServer::accept_clients() {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  const int fd =
      accept4(listener_.number(), reinterpret_cast<sockaddr*>(&address), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (fd < 0) return;
  const int yes = 1;
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  Client& client = clients_.emplace_back(fd, name_of(address));
  if (clients_.size() > options_.max_clients)
    return cut(client, "the limit of " + std::to_string(options_.max_clients) + " clients is reached");
  // liblcm waits for it before anything else, and so does a client of another protocol.
  client.output.push_back(std::make_shared<const std::string>(hello_of_server()));
  client.waiting = hello_bytes;
  send(client);
}

void TcpqServer::read(Client& client) {
  if (client.left) return;
  const ssize_t got = recv(client.socket.number(), part_.data(), part_.size(), 0);
  if (got > 0) client.input.append(part_.data(), static_cast<std::size_t>(got));
  if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) return cut(client, "");
  // liblcm sends a message in five parts, each of which the kernel keeps back until the one before is acknowledged.
  const int yes = 1;
  setsockopt(client.socket.number(), IPPROTO_TCP, TCP_QUICKACK, &yes, sizeof yes);
  if (!client.greeted && client.input.size() >= hello_bytes) {
    if (number_at(client.input, 0) != magic_of_client) return cut(client, "it does not speak tcpq");
    client.greeted = true;
    client.input.erase(0, hello_bytes);
  }
  if (client.greeted) take_requests(client);
}

void TcpqServer::take_requests(Client& client) {
  std::size_t taken = 0;
  for (std::optional<TcpqRequest> request; !client.left; taken += request->size) {
    auto error = read_tcpq_request(std::string_view(client.input).substr(taken), request);
    if (!error && !request) break;
    if (!error && request->kind == TcpqRequest::Kind::publish) pass_on(*request);
    if (!error && request->kind == TcpqRequest::Kind::subscribe) error = client.patterns.add(request->channel);
    if (!error && request->kind == TcpqRequest::Kind::unsubscribe) client.patterns.remove(request->channel);
    if (error) return cut(client, *error);
  }
  client.input.erase(0, taken);
}

void TcpqServer::pass_on(const TcpqRequest& message) {
  ++messages_;
  const std::string channel(message.channel);
  std::shared_ptr<const std::string> bytes;
  for (Client& client : clients_) {
    if (client.left || !client.patterns.matches(channel)) continue;
    if (!bytes) {
      std::string text;
      text.reserve(12 + channel.size() + message.payload.size());
      append_number(text, static_cast<std::size_t>(TcpqRequest::Kind::publish));
      append_number(text, channel.size());
      text += channel;
      append_number(text, message.payload.size());
      text += message.payload;
      bytes = std::make_shared<const std::string>(std::move(text));
    }
    if (client.waiting + bytes->size() > options_.max_waiting_bytes) {
      cut(client, "it did not read " + std::to_string(client.waiting) + " bytes that wait for it (limit " +
                      std::to_string(options_.max_waiting_bytes) + ")");
      continue;
    }
    client.output.push_back(bytes);
    client.waiting += bytes->size();
    if (client.output.size() == 1) send(client);
  }
}

void TcpqServer::send(Client& client) {
  while (!client.left && !client.output.empty()) {
    const std::string& first = *client.output.front();
    const ssize_t count =
        ::send(client.socket.number(), first.data() + client.sent, first.size() - client.sent, MSG_NOSIGNAL);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (count < 0) return cut(client, "");
    client.sent += static_cast<std::size_t>(count);
    client.waiting -= static_cast<std::size_t>(count);
    if (client.sent < first.size()) continue;
    client.output.pop_front();
    client.sent = 0;
  }
}

void TcpqServer::cut(Client& client, const std::string& why) {
  if (client.left) return;
  client.left = true;
  shutdown(client.socket.number(), SHUT_RDWR);
  client.output.clear();
  client.patterns = {};
  if (why.empty()) return;
  // Clients that come again and again must not fill the terminal, or the disk.
  constexpr int max_lines_per_s = 10;
  if (const auto now = Clock::now(); now - lines_since_ > std::chrono::seconds(1)) {
    lines_since_ = now;
    lines_ = 0;
  }
  if (++lines_ <= max_lines_per_s) report_("client " + client.name + " is disconnected: " + why);
}

void TcpqServer::cut_silent_clients(Clock::time_point now) {
  for (Client& client : clients_)
    if (!client.greeted && now - client.since > hello_time) cut(client, "no greeting within 10 s");
}

}  // namespace bridges
