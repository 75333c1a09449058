// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace navigation {

/// Whether the command line is that of the offline mode, which has --log.
bool is_offline(int argc, const char* const* argv);
/// Runs algorithms on a record.  Returns the exit code.
int run_offline_command(int argc, const char* const* argv);

}  // namespace navigation
