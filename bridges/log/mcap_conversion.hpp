// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/log/record_file.hpp"
#include "shoal/message_schema.hpp"

namespace bridges {

/// Options of a conversion of an LCM event log into an MCAP file.
struct McapConversion {
  std::string log, out;
  Existing existing = Existing::refuse;
  /// Returns whether a channel is converted; empty: all are.
  std::function<bool(std::string_view channel)> wants;
  /// Called after every event with the bytes of the log that were read, and its size; empty: no progress.
  std::function<void(std::uint64_t done, std::uint64_t total)> progress;
};

/// Result of a conversion.
struct McapConverted {
  std::uint64_t events = 0;       ///< of the log that were converted
  std::uint64_t not_decoded = 0;  ///< of these, kept as bytes
  std::uint64_t messages = 0;
  std::size_t channels = 0;
  std::uint64_t bytes = 0;                  ///< of the file
  std::vector<std::string> log_problems;    ///< of the log, such as a damaged event
  std::vector<std::string> problems;        ///< of its messages
  std::optional<std::string> time_problem;  ///< where time goes back
};

/// Converts a log.  Throws BusError when a file cannot be read, created or written, and for times outside of what an
/// MCAP file can hold.
McapConverted convert_to_mcap(const McapConversion& conversion, const shoal::MessageTypes& types);

}  // namespace bridges
