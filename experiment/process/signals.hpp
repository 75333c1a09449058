// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace experiment {

/// Installs signal handlers: SIGINT, SIGTERM and SIGHUP end the run at the next step.  A second signal, half a second
/// later or more, ends the program at once with exit code 128 plus its number, in case a step does not end.  SIGPIPE
/// ends the program unless it is ignored.
void catch_signals(bool ignore_pipe);

/// Marks an orderly end of the run, which is reported: while this object exists, two more signals are needed to end the
/// program at once.
struct OrderlyEnd {
  OrderlyEnd();
  ~OrderlyEnd();
  OrderlyEnd(const OrderlyEnd&) = delete;
  OrderlyEnd& operator=(const OrderlyEnd&) = delete;
};
/// Returns the signal that was caught, or 0.
int caught_signal();
/// Returns the number of signals that were caught.
int caught_signals();

}  // namespace experiment
