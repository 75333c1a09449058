// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/base/forked_work.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

#include "bridges/base/file_descriptor.hpp"

namespace bridges {

namespace {

using Clock = std::chrono::steady_clock;

/// Reads all bytes up to the end; std::nullopt if the deadline comes first.
std::optional<std::string> read_until(int from, std::optional<Clock::time_point> deadline) {
  std::string bytes;
  std::string chunk(1 << 16, '\0');
  for (;;) {
    const auto left =
        deadline ? std::chrono::ceil<std::chrono::milliseconds>(*deadline - Clock::now()).count() : std::int64_t{1000};
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

bool write_all(int to, const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t written = write(to, bytes.data() + at, bytes.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += static_cast<std::size_t>(written);
  }
  return true;
}

ForkedWork run_forked(const std::function<int(int to)>& work, std::optional<Clock::time_point> deadline) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category());
  const FileDescriptor from(ends[0]);
  FileDescriptor to(ends[1]);
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category());
  if (child == 0) {
    try {
      _exit(work(ends[1]));
    } catch (...) {
      _exit(1);
    }
  }
  // The end for writing must be closed here, or reading would never see the end of the child's output.
  { const FileDescriptor closed = std::move(to); }
  ForkedWork result{read_until(from.number(), deadline)};
  if (!result.output) kill(child, SIGKILL);
  while (waitpid(child, &result.status, 0) < 0 && errno == EINTR) {
  }
  return result;
}

}  // namespace bridges
