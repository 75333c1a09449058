// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <string>

namespace lcm_test {

inline bool write_file(const char* path, const std::string& text) {
  return !!(std::ofstream(path) << text << std::flush);
}

/// As `unshare -rn`: its own network, with nothing but a loopback interface that is down, and its root.
inline bool enter_own_network() {
  const std::string uid = std::to_string(getuid()), gid = std::to_string(getgid());
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
  return write_file("/proc/self/setgroups", "deny") && write_file("/proc/self/uid_map", "0 " + uid + " 1") &&
         write_file("/proc/self/gid_map", "0 " + gid + " 1");
}

inline constexpr int not_permitted = 77;

/// The answer of `judge`, called in a child process in its own network: 0 yes, 1 no, or not_permitted.
inline int in_own_network(const std::function<bool()>& judge) {
  const pid_t child = fork();
  if (child == 0) {
    if (!enter_own_network()) _exit(not_permitted);
    bool good = false;
    try {
      good = judge();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    _exit(good ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace lcm_test
