// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace experiment {

/// Result of a program that was run to its end.
struct ProgramOutput {
  int exit_code = 0;  ///< 128 plus the number of the signal that killed it
  std::string text;   ///< its stdout and stderr
};

/// Throws std::runtime_error when PATH has no such program: `sbatch is not installed: ...`.  `package`: that of Debian.
void require_program(const std::string& name, const std::string& package);

/// Runs a program, `arguments[0]` from PATH, with its output kept.  Throws std::runtime_error when it cannot start.
ProgramOutput output_of(const std::vector<std::string>& arguments);

/// Runs a program with our output, and ends it after a signal, by two of SIGTERM.  Returns its exit code.
int run_outside_program(const std::vector<std::string>& arguments);

/// Absolute path of this program.
std::string own_program();

}  // namespace experiment
