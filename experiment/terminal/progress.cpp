// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/terminal/progress.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "sim/base/text_layout.hpp"

namespace experiment {

Progress::Progress(double duration_s, bool quiet)
    : duration_s_(duration_s), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), last_(Clock::now()) {}

void Progress::update(sim::Time now, std::uint64_t messages, const sim::RunControl& control, bool waits) {
  if (quiet_ || asking_ || (++skip_ < 16 && !waits)) return;  // reading the clock at every step would be expensive
  skip_ = 0;
  const Clock::time_point wall = Clock::now();
  const double since_s = std::chrono::duration<double>(wall - last_).count();
  if (since_s < (terminal_ ? 0.25 : 10.0)) return;
  std::string line = fmt::format("{:8.2f} s", sim::to_seconds(now));
  if (duration_s_ > 0) line += fmt::format(" / {:.0f} s", duration_s_);
  if (!control.paused)
    line += fmt::format("  {:7.2f} x real time  {:8.0f} messages/s", sim::to_seconds(now - last_now_) / since_s,
                        static_cast<double>(messages - last_messages_) / since_s);
  if (control.branch > 0) line += fmt::format("  branch {}", control.branch);
  if (control.paused)
    line += "  paused; space or `shoal control resume` continues";
  else if (waits)
    line += "  paused";
  show(line);
  last_ = wall;
  last_now_ = now;
  last_messages_ = messages;
}

void Progress::show(const std::string& line) {
  if (terminal_) {
    // The next line would not overwrite a line that fills the last column.
    const auto columns = static_cast<std::size_t>(sim::text_columns(STDERR_FILENO)) - 1;
    const std::string fitted = sim::cut_to(line, columns);
    const std::size_t width = sim::column_count(fitted);
    std::fprintf(stderr, "\r%s%*s", fitted.c_str(), static_cast<int>(width_ > width ? width_ - width : 0), "");
    width_ = width;
    shown_ = true;
  } else {
    std::fprintf(stderr, "%s\n", line.c_str());
  }
  std::fflush(stderr);
}

void Progress::clear() {
  asking_ = false;
  if (!shown_) return;
  std::fprintf(stderr, "\r%*s\r", static_cast<int>(width_), "");
  std::fflush(stderr);
  shown_ = false;
  width_ = 0;
}

void Progress::report(const std::string& text) {
  clear();
  std::fprintf(stderr, "%s\n", text.c_str());
  std::fflush(stderr);
}

void Progress::send_request(const std::string& text) {
  asking_ = true;
  show(text);
}

void Progress::restart(sim::Time now) {
  last_ = Clock::now();
  last_now_ = now;
}

}  // namespace experiment
