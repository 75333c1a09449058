// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

// Ports for tests and measurements that run at the same time.  tests/own_ports.py does the same, with the same locks.

namespace test_support {

/// The ports start here, end below 32768, where the kernel takes ports of its own, and belong together by eight.
constexpr int first_own_port = 10'000, ports_of_a_slot = 8, port_slots = 2500;

/// Whether no socket has the port, such as one of a program that a test left behind.
inline bool is_free_port(int port) {
  for (const int type : {SOCK_DGRAM, SOCK_STREAM}) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<in_port_t>(port));
    const int probe = socket(AF_INET, type | SOCK_CLOEXEC, 0);
    const bool free = probe >= 0 && bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    close(probe);
    if (!free) return false;
  }
  return true;
}

/// Takes the eight ports of a slot until this process ends, and returns the first; 0 when another process has them, of
/// any user.  The lock is a name in the kernel: like the ports it is one for all in a network namespace, and it is gone
/// with its process.
inline int take_port_slot(int slot) {
  const int lock = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (lock < 0) throw std::system_error(errno, std::generic_category(), "cannot lock ports");
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  const std::string text = "shoal-test-ports-" + std::to_string(slot);
  std::memcpy(name.sun_path + 1, text.data(), text.size());  // a name that starts with 0 is not a file
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
  bool free = bind(lock, reinterpret_cast<const sockaddr*>(&name), size) == 0;
  if (!free && errno != EADDRINUSE) throw std::system_error(errno, std::generic_category(), "cannot lock ports");
  const int first = first_own_port + ports_of_a_slot * slot;
  for (int i = 0; free && i < ports_of_a_slot; ++i) free = is_free_port(first + i);
  if (free) return first;
  close(lock);
  return 0;
}

/// The first of eight ports that no other test has until this process ends, from the given slot on.
inline int own_ports(int slot = static_cast<int>(getpid())) {
  for (int i = 0; i < port_slots; ++i)
    if (const int first = take_port_slot((slot + i) % port_slots)) return first;
  throw std::runtime_error("other processes have all ports for tests");
}

/// A port of this process's own, offset 0 to 7.
inline int own_port(int offset = 0) {
  static const int first = own_ports();
  return first + offset;
}

/// The LCM URL of a port of this process's own: LCM 1.3 keeps apart ports only.
inline std::string own_url(int offset = 0) {
  return "udpm://239.255.76.67:" + std::to_string(own_port(offset)) + "?ttl=0";
}

}  // namespace test_support
