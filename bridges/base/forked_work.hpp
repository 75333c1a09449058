// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

namespace bridges {

/// What came of work in a child process.
struct ForkedWork {
  std::optional<std::string> output;  ///< what it wrote; std::nullopt: it did not end in time, and was killed
  int status = 0;                     ///< as of waitpid()
};

/// Runs `work` in a copy of this process, where it may crash, and waits for it.  `work` writes its output to the
/// descriptor that it is given; what it returns is the exit code, 1 if it throws.  The child ends without destructors,
/// handlers and flushing, which belong to this process.  Throws std::system_error when no child can be started: EMFILE
/// or ENFILE when there is no descriptor.
ForkedWork run_forked(const std::function<int(int to)>& work,
                      std::optional<std::chrono::steady_clock::time_point> deadline = std::nullopt);

/// Writes all bytes; returns false when that is not possible.
bool write_all(int to, const std::string& bytes);

}  // namespace bridges
