// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace bridges {

/// What one check of `shoal doctor` found.
struct Finding {
  enum class Verdict { ok, warning, bad };
  std::string name;  ///< "multicast route"
  Verdict verdict = Verdict::ok;
  std::string text;
  std::vector<std::string> commands;  ///< to type, as root, in this order
};

/// Whether LCM works here with this URL (empty: the one a run would use), and if not, why.  Opens no LCM in
/// this process: the round trip is made in a child, as liblcm may block or abort.  For a program without
/// other threads.
std::vector<Finding> check_network(const std::string& url = {},
                                   std::chrono::milliseconds time_limit = std::chrono::milliseconds(3000));

}  // namespace bridges
