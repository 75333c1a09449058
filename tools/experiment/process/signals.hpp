// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tools {

/// SIGINT, SIGTERM and SIGHUP end the run at the next step, once this was called.  Another one, half a second later or
/// more, ends the program at once with 128 and its number as exit code: for a step that does not end.  SIGPIPE ends the
/// program unless it is ignored.
void catch_signals(bool ignore_pipe);

/// While this object exists the run is ending and reports it: two more signals are needed to end the program at once.
struct OrderlyEnd {
  OrderlyEnd();
  ~OrderlyEnd();
  OrderlyEnd(const OrderlyEnd&) = delete;
  OrderlyEnd& operator=(const OrderlyEnd&) = delete;
};
/// The signal that came, or 0.
int caught_signal();
/// How many came.
int caught_signals();

}  // namespace tools
