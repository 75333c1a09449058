#pragma once

#include <optional>
#include <string>

namespace tools {

/// Reads single keys from the terminal while a run goes.  The terminal gets its settings back when this goes, when the
/// program is stopped (Ctrl-Z) and when a signal kills it.  In the background nothing is read, so that the job is not
/// stopped.
class TerminalKeys {
 public:
  /// Standard input and standard error are terminals.
  static bool possible();

  TerminalKeys();
  ~TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  /// The next key, when one was pressed.  Never waits.
  std::optional<char> next();
};

}  // namespace tools
