// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/world_warnings.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"

namespace sim {

void WorldWarnings::bad_message(const std::string& who, const std::string& text) {
  ++bad_messages_;
  // Log one line for each kind of error, to limit the lines caused by a flood of bad messages.
  constexpr std::size_t max_lines = 100;
  const std::string line = who + ": " + shortened(printable(text), 300);
  if (lines_.size() >= max_lines || std::find(lines_.begin(), lines_.end(), line) != lines_.end()) return;
  lines_.push_back(line);
  log_warn("{} (ignored, at {:.3f} s)", line, to_seconds(clock_.now()));
}

void WorldWarnings::keep_for_end(const std::string& who, const std::string& text) {
  constexpr std::size_t max_lines = 100;
  if (kept_.size() >= max_lines || std::find(kept_of_.begin(), kept_of_.end(), who) != kept_of_.end()) return;
  kept_of_.push_back(who);
  kept_.push_back(who + ": " + text + fmt::format(" (at {:.2f} s)", to_seconds(clock_.now())));
}

void WorldWarnings::warn(const std::string& who, const std::string& text) const {
  log_warn("{}: {} (at {:.3f} s)", who, text, to_seconds(clock_.now()));
}

void WorldWarnings::device_fault(const std::string& device, const std::string& text) const {
  warn(device, text);
  if (fault_listener_) fault_listener_(device, text);
}

}  // namespace sim
