// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/mesh/child_work.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spdlog/fmt/fmt.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <optional>

namespace tools {

namespace {

using Clock = std::chrono::steady_clock;

void set_limit(__rlimit_resource resource, std::size_t value) {
  const rlimit limit{value, value};
  setrlimit(resource, &limit);
}

void write_all(int to, const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t written = write(to, bytes.data() + at, bytes.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(1);
    at += static_cast<std::size_t>(written);
  }
}

/// Ends without destructors and without flushing, which belong to the parent.
[[noreturn]] void be_child(const std::function<std::string()>& work, const ChildLimits& limits, int to) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int fatal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) signal(fatal, SIG_DFL);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  set_limit(RLIMIT_CORE, 0);
#ifndef __SANITIZE_ADDRESS__
  set_limit(RLIMIT_AS, limits.memory_bytes);
#endif
  try {
    write_all(to, work());
  } catch (...) {
    _exit(1);
  }
  _exit(0);
}

/// Reads all bytes up to the end; std::nullopt if the time limit is exceeded.
std::optional<std::string> read_until(int from, Clock::time_point deadline) {
  std::string bytes;
  std::string chunk(1 << 16, '\0');
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return std::nullopt;
    pollfd waiting{from, POLLIN, 0};
    if (poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left, 1000))) <= 0) continue;
    const ssize_t count = read(from, chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(chunk, 0, static_cast<std::size_t>(count));
  }
}

}  // namespace

std::string do_in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.time_s));
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw ChildError("could not be started");
  // Assimp may crash, loop or take all memory on a broken file. A child process keeps that from the command, and from
  // its users.
  const pid_t child = fork();
  if (child == 0) be_child(work, limits, ends[1]);
  // The end for writing must be closed here, or reading would never see the end of the child's output.
  close(ends[1]);
  std::optional<std::string> bytes;
  if (child > 0) bytes = read_until(ends[0], deadline);
  close(ends[0]);
  if (child < 0) throw ChildError("could not be started");
  if (!bytes) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!bytes) throw ChildError(fmt::format("took longer than {:g} s", limits.time_s));
  if (status != 0) throw ChildError("failed on this file");
  return *bytes;
}

}  // namespace tools
