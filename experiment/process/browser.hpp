// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace experiment {

/// Returns the command that shows an address: `browser`, which is the value of `$BROWSER`, else `xdg-open`.  Of several
/// programs in `browser`, separated by colons, the first one.  Its words are arguments; `%s` in them is the address,
/// which is otherwise the last argument.
std::vector<std::string> browser_command(std::string_view browser, const std::string& url);

/// Browser of the user.  It is not a part of the run: it does not receive Ctrl-C, it may outlive this program, and when
/// it cannot be started or fails there is only a warning.
class Browser {
 public:
  /// Shows an address.
  void open(const std::string& url);

 private:
  std::jthread watch_;  // until the program has ended
};

}  // namespace experiment
