// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace experiment {

/// Reads single keys from the terminal during a run.  Restores the settings of the terminal on destruction, when the
/// program is stopped (Ctrl-Z) and when a signal kills it.  In the background nothing is read, so that the job is not
/// stopped; it takes over the terminal when it comes to the foreground.
class TerminalKeys {
 public:
  /// Returns whether standard input and standard error are terminals.
  static bool possible();

  TerminalKeys();
  ~TerminalKeys();
  /// Restores the original settings, if they were changed; for signal handlers.
  static void restore_saved();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  /// Returns the next key that was pressed, if any.  Does not wait.
  std::optional<char> next();

 private:
  std::chrono::steady_clock::time_point check_at_{};  ///< time of the next check of the settings
};

}  // namespace experiment
