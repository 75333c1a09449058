// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/moos_connection.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <utility>

namespace bridges {

namespace {

constexpr int connect_timeout_ms = 5000, retry_ms = 1000;
double wall_now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

MoosError no_connection(int error) {
  return MoosError(std::string("no connection: ") + std::strerror(error));
}

/// Waits until a socket has connected, which may fail.
void await_connection(int socket, int wake) {
  std::array<pollfd, 2> polled{{{socket, POLLOUT, 0}, {wake, POLLIN, 0}}};
  if (poll(polled.data(), polled.size(), connect_timeout_ms) <= 0) throw no_connection(ETIMEDOUT);
  int error = 0;
  socklen_t size = sizeof error;
  getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
  if (polled[0].revents == 0) throw no_connection(ECANCELED);
  if (error != 0) throw no_connection(error);
}

}  // namespace

FileDescriptor connect_tcp(const std::string& host, int port, int wake) {
  addrinfo hints{};
  hints.ai_family = AF_INET;  // a MOOSDB listens on IPv4 only
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int failed = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, &freeaddrinfo);
  if (failed != 0) throw MoosError("host '" + host + "' is unknown: " + gai_strerror(failed));
  FileDescriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket.number() < 0) throw no_connection(errno);
  const int yes = 1;
  setsockopt(socket.number(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  if (connect(socket.number(), addresses->ai_addr, addresses->ai_addrlen) != 0) {
    if (errno != EINPROGRESS) throw no_connection(errno);
    await_connection(socket.number(), wake);
  }
  return socket;
}

MoosConnection::MoosConnection(Options options) : options_(std::move(options)) {
  thread_ = std::thread([this] { run(); });
}

MoosConnection::~MoosConnection() {
  stopping_ = true;
  wake_.set();
  thread_.join();
}

void MoosConnection::notify(const std::vector<MoosValue>& values) {
  if (!open_ || values.empty()) return;
  const std::lock_guard lock(mutex_);
  if (!session_) return;
  session_->notify(values, wall_now_s());
  write();
  if (!session_->output().empty()) wake_.set();  // the thread waits until the socket takes more
}

bool MoosConnection::await_open(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  return opened_.wait_for(lock, timeout, [this] { return open_.load(); });
}

void MoosConnection::set_open(bool open) {
  {
    const std::lock_guard lock(mutex_);
    open_ = open;
    if (!open) session_.reset();
  }
  opened_.notify_all();
}

void MoosConnection::report_once(const std::string& sentence) {
  if (sentence == std::exchange(last_report_, sentence) || !options_.report) return;
  options_.report("MOOSDB at " + options_.host + ":" + std::to_string(options_.port) + ": " + sentence);
}

void MoosConnection::run() {
  while (!stopping_) {
    try {
      socket_ = connect_tcp(options_.host, options_.port, wake_.fd());
      serve();
    } catch (const MoosError& error) {
      set_open(false);
      if (stopping_) break;
      report_once(std::string(error.what()) + "; trying again each second");
      wait_for_next_try();
    }
  }
}

void MoosConnection::wait_for_next_try() {
  pollfd polled{wake_.fd(), POLLIN, 0};
  if (poll(&polled, 1, retry_ms) > 0) wake_.clear();
}

void MoosConnection::serve() {
  {
    const std::lock_guard lock(mutex_);
    session_.emplace(options_.terms, wall_now_s());
    write();
  }
  while (!stopping_) {
    std::array<pollfd, 2> polled{{{socket_.number(), POLLIN, 0}, {wake_.fd(), POLLIN, 0}}};
    {
      const std::lock_guard lock(mutex_);
      if (!session_->output().empty()) polled[0].events |= POLLOUT;
    }
    poll(polled.data(), polled.size(), 1000);  // for keep_alive()
    if (polled[1].revents != 0) wake_.clear();
    std::vector<MoosMessage> received;
    if ((polled[0].revents & ~POLLOUT) != 0) received = read();
    if (session_->is_open() && !open_) {
      set_open(true);
      report_once("connected to community '" + session_->community() + "' as '" + options_.terms.name + "'");
    }
    if (!received.empty() && options_.on_received) options_.on_received(received);
    const std::lock_guard lock(mutex_);
    session_->keep_alive(wall_now_s());
    write();
  }
}

std::vector<MoosMessage> MoosConnection::read() {
  std::array<std::byte, 65536> bytes;
  const ssize_t count = recv(socket_.number(), bytes.data(), bytes.size(), 0);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  if (count <= 0) throw MoosError("the connection was closed");
  const std::lock_guard lock(mutex_);
  session_->receive({bytes.data(), static_cast<std::size_t>(count)}, wall_now_s());
  return session_->take_received();
}

void MoosConnection::write() {
  const auto output = session_->output();
  if (output.empty()) return;
  const ssize_t count = send(socket_.number(), output.data(), output.size(), MSG_NOSIGNAL);
  if (count > 0) session_->sent(static_cast<std::size_t>(count));  // an error is seen by the next read()
}

}  // namespace bridges
