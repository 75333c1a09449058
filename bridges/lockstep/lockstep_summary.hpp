// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace bridges {

/// How a client took part in a run.
struct LockstepSummary {
  std::string client;
  std::int64_t ticks = 0;
  std::int64_t repeated_ticks = 0;       ///< sent again, as no answer came
  std::int64_t messages_sent_again = 0;  ///< to the client, as it had not received them
  std::int64_t messages_asked_for = 0;   ///< of the client, as they had not come here
  std::int64_t messages_repeated = 0;    ///< dropped, as they equal one of the client's that came before
  std::int64_t timeouts = 0;
  std::int64_t contradictions = 0;  ///< answers that differ from its first answer to the same tick
  std::string ended;                ///< empty: it took part until the end
};

}  // namespace bridges
