// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace bridges {

/// Executable, arguments and environment of a program to start.
struct ChildProgram {
  std::string path;                      ///< with a slash, or looked up in PATH
  std::vector<std::string> arguments;    ///< the first is the program name (argv[0])
  std::vector<std::string> environment;  ///< `NAME=value`
  std::string log;                       ///< file for its output; empty: our output
  int input = -1;                        ///< descriptor of its standard input; -1: empty
  bool stays = false;                    ///< in its own session, without our files, and not ended with us
};

/// Starts a program in its own process group, with default signal handling.  Unless it `stays` it receives SIGTERM when
/// the thread that starts it ends for any reason.  Returns 0, or the error as in errno.
int start_child(const ChildProgram& program, pid_t& pid);

/// Returns whether there is an executable file of this name; without a slash, in a folder of PATH.
bool is_program(const std::string& name);

/// Returns the environment of this process.
std::vector<std::string> own_environment();

/// Quotes a word for a POSIX shell, if that is necessary.
std::string shell_word(const std::string& word);

}  // namespace bridges
