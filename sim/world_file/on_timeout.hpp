// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/choice_words.hpp"

namespace sim {

/// Action when a client of the lockstep does not answer in time.
enum class OnTimeout {
  wait,     ///< the world waits forever
  pause,    ///< the world pauses until the client answers, or until another one resumes the run without it
  go_on,    ///< the run continues without the client
  end_run,  ///< the run ends with exit code 5
};

inline constexpr ChoiceWords<OnTimeout> on_timeout_words{{"wait", OnTimeout::wait},
                                                         {"pause", OnTimeout::pause},
                                                         {"continue", OnTimeout::go_on},
                                                         {"end", OnTimeout::end_run}};

}  // namespace sim
