// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace bridges {

/// Result of one check of `shoal doctor`.
struct Finding {
  enum class Verdict { ok, warning, bad };
  std::string name;  ///< "multicast route"
  Verdict verdict = Verdict::ok;
  std::string text;
  std::vector<std::string> commands;  ///< remedy: commands to execute as root, in this order
};

/// Checks whether LCM works on this machine with this URL (empty: the one that a run would use), and finds the reason
/// if not.  Opens no LCM in this process: the round trip is made in a child process, because liblcm may block or abort.
/// Only for a program without other threads.
std::vector<Finding> check_network(const std::string& url = {},
                                   std::chrono::milliseconds time_limit = std::chrono::milliseconds(3000));

}  // namespace bridges
