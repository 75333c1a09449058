// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace bridges {

/// Summary of a client in the lockstep of a run.
struct LockstepSummary {
  std::string client;
  std::int64_t ticks = 0;
  std::int64_t repeated_ticks = 0;      ///< ticks sent again because there was no answer
  std::int64_t messages_resent = 0;     ///< messages sent again to the client because it had not received them
  std::int64_t messages_requested = 0;  ///< messages requested from the client because they had not arrived
  std::int64_t messages_repeated = 0;   ///< dropped messages that were equal to an earlier one of the client
  std::int64_t timeouts = 0;
  std::int64_t contradictions = 0;  ///< answers that differ from its first answer to the same tick
  std::string ended;                ///< reason why it left; empty: in the lockstep until the end
  double ended_s = 0;               ///< simulated time of that
};

}  // namespace bridges
