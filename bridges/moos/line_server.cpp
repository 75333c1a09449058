// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/line_server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "bridges/base/bus_error.hpp"

namespace bridges {

LineServer::LineServer(int port, Handlers handlers)
    : handlers_(std::move(handlers)), listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  const int yes = 1;
  setsockopt(listener_.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<in_port_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (bind(listener_.number(), generic, size) != 0 || listen(listener_.number(), 4) != 0)
    throw BusError("cannot listen on 127.0.0.1:" + std::to_string(port) + ": " + std::strerror(errno));
  getsockname(listener_.number(), generic, &size);
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { run(); });
}

LineServer::~LineServer() {
  stopping_ = true;
  wake_.set();
  thread_.join();
}

void LineServer::send(const std::string& text) {
  if (!has_client_ || text.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    if (output_.size() <= max_waiting_bytes) output_ += text;
  }
  wake_.set();
}

void LineServer::run() {
  while (!stopping_) {
    std::array<pollfd, 3> polled{
        {{wake_.fd(), POLLIN, 0}, {listener_.number(), POLLIN, 0}, {client_.number(), POLLIN, 0}}};
    bool is_too_slow = false;
    {
      const std::lock_guard lock(mutex_);
      if (!output_.empty()) polled[2].events |= POLLOUT;
      is_too_slow = output_.size() > max_waiting_bytes;
    }
    if (is_too_slow) {
      drop_client();
      continue;
    }
    if (poll(polled.data(), polled.size(), -1) < 0) continue;  // without a client, the third is ignored
    if (polled[0].revents != 0) wake_.clear();
    if (has_client_ && polled[2].revents != 0) serve_client(polled[2].revents);
    if (polled[1].revents != 0) accept_client();
  }
}

void LineServer::accept_client() {
  FileDescriptor accepted(accept4(listener_.number(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (accepted.number() < 0 || has_client_) return;  // a second client is closed at once
  const int yes = 1;
  setsockopt(accepted.number(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  client_ = std::move(accepted);
  has_client_ = true;
  if (handlers_.connected) handlers_.connected();
}

void LineServer::drop_client() {
  has_client_ = false;
  client_ = FileDescriptor();
  const std::lock_guard lock(mutex_);
  output_.clear();
}

void LineServer::serve_client(short events) {
  if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) {
    std::array<char, 16384> bytes;
    const ssize_t count = recv(client_.number(), bytes.data(), bytes.size(), 0);
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) return drop_client();
    if (count > 0) send(handlers_.received({bytes.data(), static_cast<std::size_t>(count)}));
  }
  const std::lock_guard lock(mutex_);
  const ssize_t sent = ::send(client_.number(), output_.data(), output_.size(), MSG_NOSIGNAL);
  if (sent > 0) output_.erase(0, static_cast<std::size_t>(sent));
}

}  // namespace bridges
