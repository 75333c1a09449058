// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "bridges/base/file_descriptor.hpp"

namespace nmea_test {

inline sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// Client of an NMEA server with a plain socket.
class Peer {
 public:
  explicit Peer(std::uint16_t port, int receive_bytes = 0) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (receive_bytes > 0) setsockopt(socket_.number(), SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof receive_bytes);
    const sockaddr_in address = loopback(port);
    if (connect(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("cannot connect");
  }

  /// Returns false once the server has closed the connection.
  bool send(const std::string& bytes) const {
    return ::send(socket_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0;
  }
  /// The next line, without its end; none once the server has closed the connection.  Throws after a minute.
  std::optional<std::string> line() {
    std::size_t end = 0;
    while ((end = received_.find("\r\n")) == std::string::npos) {
      pollfd readable{socket_.number(), POLLIN, 0};
      if (poll(&readable, 1, 60'000) <= 0) throw std::runtime_error("no line came");
      char bytes[4096];
      const ssize_t size = recv(socket_.number(), bytes, sizeof bytes, 0);
      if (size <= 0) return std::nullopt;
      received_.append(bytes, static_cast<std::size_t>(size));
    }
    const std::string found = received_.substr(0, end);
    received_.erase(0, end + 2);
    return found;
  }
  /// The next line that contains this text; none once the server has closed the connection.
  std::optional<std::string> line_with(const std::string& text) {
    while (auto next = line())
      if (next->find(text) != std::string::npos) return next;
    return std::nullopt;
  }

 private:
  bridges::FileDescriptor socket_;
  std::string received_;
};

}  // namespace nmea_test
