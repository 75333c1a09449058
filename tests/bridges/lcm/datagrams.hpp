// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "sim/bus/bus.hpp"

// Datagrams of LCM's udpm, written by hand, as they should be and as they should not.
namespace lcm_test {

inline void append(sim::Bytes& bytes, std::uint64_t value, int size) {
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) bytes.push_back(static_cast<std::byte>(value >> shift));
}

inline void append(sim::Bytes& bytes, std::string_view text) {
  for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
}

/// A message in one datagram.
inline sim::Bytes short_datagram(std::string_view channel, std::string_view payload, std::uint32_t sequence = 1) {
  sim::Bytes bytes;
  append(bytes, 0x4c433032, 4);
  append(bytes, sequence, 4);
  append(bytes, channel);
  append(bytes, 0, 1);
  append(bytes, payload);
  return bytes;
}

/// One of several datagrams of a message.  Fragment 0 carries the channel before its part of the payload.
struct Fragment {
  std::uint32_t sequence = 1;
  std::uint32_t message_bytes = 0;
  std::uint32_t offset = 0;
  std::uint16_t number = 0;
  std::uint16_t count = 0;
  std::string_view channel = {};
  std::string_view payload = {};
};

inline sim::Bytes fragment_datagram(const Fragment& fragment) {
  sim::Bytes bytes;
  append(bytes, 0x4c433033, 4);
  append(bytes, fragment.sequence, 4);
  append(bytes, fragment.message_bytes, 4);
  append(bytes, fragment.offset, 4);
  append(bytes, fragment.number, 2);
  append(bytes, fragment.count, 2);
  if (fragment.number == 0) {
    append(bytes, fragment.channel);
    append(bytes, 0, 1);
  }
  append(bytes, fragment.payload);
  return bytes;
}

/// Sends datagrams to an address and port, from its own port.
class DatagramSocket {
 public:
  DatagramSocket(const std::string& address, int port) : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(static_cast<std::uint16_t>(port));
    if (fd_ < 0 || inet_pton(AF_INET, address.c_str(), &to_.sin_addr) != 1)
      throw std::runtime_error("no socket for " + address);
  }
  ~DatagramSocket() { close(fd_); }
  DatagramSocket(const DatagramSocket&) = delete;
  DatagramSocket& operator=(const DatagramSocket&) = delete;

  int fd() const { return fd_; }
  bool send(const sim::Bytes& bytes) const {
    return sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_) ==
           static_cast<ssize_t>(bytes.size());
  }

 private:
  int fd_;
  sockaddr_in to_{};
};

}  // namespace lcm_test
