// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "sim/config/config_node.hpp"

namespace experiment {

/// Returns the files that a tree was read from.
std::set<std::string> files_of(const sim::ConfigNode& tree);

/// Files that are watched for being saved: by their size and the time of their last change, four times per second.
class WatchedFiles {
 public:
  explicit WatchedFiles(const std::set<std::string>& paths) { add(paths); }

  /// Watches further files, from their present state on.
  void add(const std::set<std::string>& paths);
  /// Returns true from the time on at which a file has another state than at the start, and the same one as a quarter
  /// of a second before: it is no longer written to.  Cheap: most calls only read a clock.
  bool changed();

 private:
  using Clock = std::chrono::steady_clock;
  /// State of a file; size -1: there is none.
  struct State {
    std::int64_t size = -1;
    std::filesystem::file_time_type time = {};
    bool operator==(const State&) const = default;
  };
  static State state_of(const std::string& path);

  std::map<std::string, State> first_, last_;
  Clock::time_point next_look_ = {};
  bool changed_ = false;
};

}  // namespace experiment
