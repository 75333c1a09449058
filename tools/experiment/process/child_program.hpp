// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace tools {

/// A program to start.
struct ChildProgram {
  std::string path;                      ///< with a slash, or looked up in PATH
  std::vector<std::string> arguments;    ///< the first is what it is called
  std::vector<std::string> environment;  ///< `NAME=value`
  std::string log;                       ///< file for its output; empty: where ours goes
};

/// Starts it in its own process group, with empty standard input and default signal handling.  It gets SIGTERM
/// when the thread that starts it ends, however that ends.  Returns 0, or the error as in errno.
int start_child(const ChildProgram& program, pid_t& pid);

/// Our own environment.
std::vector<std::string> own_environment();

}  // namespace tools
