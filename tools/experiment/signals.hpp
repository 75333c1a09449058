#pragma once

namespace tools {

/// SIGINT, SIGTERM and SIGHUP end the run at the next step, once this was called.  SIGPIPE ends the program unless it
/// is ignored.
void catch_signals(bool ignore_pipe);
/// The signal that came, or 0.
int caught_signal();
/// How many came.
int caught_signals();

}  // namespace tools
