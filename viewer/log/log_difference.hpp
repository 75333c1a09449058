// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "viewer/log/log_index.hpp"

namespace viewer {

/// First difference between two logs.
struct LogDifference {
  std::int64_t time_us = 0;
  std::optional<std::int64_t> step;  ///< unset: the difference is one of poses
  std::string by;                    ///< `sim.hash` or `poses`
};

/// Returns the first difference at equal times: of the hashes of the state where both logs have them, else of the poses
/// of bodies with equal names.  None: equal over the common time span.  Throws BusError.
std::optional<LogDifference> first_difference(const std::string& path_a, const LogIndex& a, const std::string& path_b,
                                              const LogIndex& b);

}  // namespace viewer
