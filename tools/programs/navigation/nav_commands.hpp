// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace navigation {

/// Whether the command line has --list.
bool is_list(int argc, const char* const* argv);
/// Prints algorithms with their meaning.  Returns the exit code.  Throws std::invalid_argument for one that is not
/// known or cannot be loaded.
int run_list_command(int argc, const char* const* argv);

/// Whether the command line is that of the offline mode, which has --log.
bool is_offline(int argc, const char* const* argv);
/// Runs algorithms on a record.  Returns the exit code.
int run_offline_command(int argc, const char* const* argv);

}  // namespace navigation
