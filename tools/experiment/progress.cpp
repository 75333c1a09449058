#include "tools/experiment/progress.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace tools {

Progress::Progress(double duration_s, bool quiet)
    : duration_s_(duration_s), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), last_(Clock::now()) {}

void Progress::update(sim::Time now, std::uint64_t messages, bool paused) {
  if (quiet_ || (++skip_ < 16 && !paused)) return;  // looking at the clock at every step would cost
  skip_ = 0;
  const Clock::time_point wall = Clock::now();
  const double since_s = std::chrono::duration<double>(wall - last_).count();
  if (since_s < (terminal_ ? 0.25 : 10.0)) return;
  const double factor = sim::to_seconds(now - last_now_) / since_s;
  const double per_second = static_cast<double>(messages - last_messages_) / since_s;
  char end[32] = "";
  if (duration_s_ > 0) std::snprintf(end, sizeof end, " / %.0f s", duration_s_);
  std::fprintf(stderr, "%s%8.2f s%s  %7.2f x real time  %8.0f messages/s%s%s", terminal_ ? "\r" : "",
               sim::to_seconds(now), end, factor, per_second, paused ? "  paused" : "        ", terminal_ ? "" : "\n");
  std::fflush(stderr);
  shown_ = terminal_;
  last_ = wall;
  last_now_ = now;
  last_messages_ = messages;
}

void Progress::clear() {
  if (!shown_) return;
  std::fprintf(stderr, "\r%*s\r", 79, "");
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace tools
