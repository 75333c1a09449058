// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <stdexcept>
#include <string>

namespace dds_test {

/// A domain of DDS of this process's own, 1 to 90: their ports are below those that the kernel takes.  The lock is a
/// name in the kernel, as in own_ports.hpp.
inline int own_domain() {
  static const int domain = [] {
    constexpr int domains = 90;
    for (int i = 0; i < domains; ++i) {
      const int number = 1 + (static_cast<int>(getpid()) + i) % domains;
      sockaddr_un name{};
      name.sun_family = AF_UNIX;
      const std::string text = "shoal-test-domain-" + std::to_string(number);
      std::memcpy(name.sun_path + 1, text.data(), text.size());
      const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
      const int lock = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
      if (bind(lock, reinterpret_cast<const sockaddr*>(&name), size) == 0) return number;
      close(lock);
    }
    throw std::runtime_error("other processes have all domains for tests");
  }();
  return domain;
}

/// A child process: Cyclone DDS has a domain once in a process.
class Peer {
 public:
  explicit Peer(const std::function<bool()>& work) : pid_(fork()) {
    if (pid_ != 0) return;
    bool good = false;
    try {
      good = work();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    _exit(good ? 0 : 1);
  }
  /// Waits for its end, and returns whether its work was good.
  bool wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

 private:
  pid_t pid_;
};

}  // namespace dds_test
