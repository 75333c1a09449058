// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace tools {

/// Reads single keys from the terminal while a run goes.  The terminal gets its settings back when this goes, when the
/// program is stopped (Ctrl-Z) and when a signal kills it.  In the background nothing is read, so that the job is not
/// stopped; it takes the terminal when it comes to the foreground.
class TerminalKeys {
 public:
  /// Standard input and standard error are terminals.
  static bool possible();

  TerminalKeys();
  ~TerminalKeys();
  /// The settings as they were, if they were changed; for signal handlers.
  static void restore_saved();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  /// The next key, when one was pressed.  Never waits.
  std::optional<char> next();

 private:
  std::chrono::steady_clock::time_point check_at_{};  ///< at the settings
};

}  // namespace tools
