// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/base/file_descriptor.hpp"

#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace bridges {

namespace {

std::string command_of(long process) {
  constexpr std::size_t max_length = 120;
  std::ifstream in("/proc/" + std::to_string(process) + "/cmdline", std::ios::binary);
  std::string text;
  std::getline(in, text, '\n');
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c >= 0x7f; }, ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.size() > max_length ? text.substr(0, max_length) + "..." : text;
}

/// Returns the owner of a lock from /proc/locks: `1: FLOCK  ADVISORY  WRITE 1234 fd:00:5678 0 EOF`.
std::string owner_of(int file) {
  struct stat status {};
  if (fstat(file, &status) != 0) return "another process";
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream in(line);
    std::string number, kind, advisory, access;
    long process = 0;
    unsigned major_number = 0, minor_number = 0;
    unsigned long inode = 0;
    char colon = 0;
    in >> number >> kind >> advisory >> access >> process >> std::hex >> major_number >> colon >> minor_number >>
        colon >> std::dec >> inode;
    const bool this_one = in && kind == "FLOCK" && inode == status.st_ino &&
                          makedev(major_number, minor_number) == status.st_dev && process > 0;
    if (!this_one) continue;
    const std::string command = command_of(process);
    return "process " + std::to_string(process) + (command.empty() ? "" : " (" + command + ")");
  }
  return "another process";
}

}  // namespace

std::optional<std::string> lock_against_others(int file) {
  int failed = 0;
  do failed = flock(file, LOCK_EX | LOCK_NB);
  while (failed != 0 && errno == EINTR);
  // A file system without locks gives no protection.
  if (failed == 0 || errno != EWOULDBLOCK) return std::nullopt;
  return owner_of(file);
}

}  // namespace bridges
