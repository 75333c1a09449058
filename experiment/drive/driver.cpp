// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/driver.hpp"

namespace experiment {

void Driver::hold(const DriveValues& values, Clock::time_point now) {
  // The first command, and a change of one, is due at once.
  if (!held_ || values != values_) next_ = now;
  values_ = values;
  held_ = true;
  sign_ = now;
}

void Driver::release() {
  if (!held_) return;
  held_ = false;
  safe_left_ = safe_commands;
  next_ = {};
}

std::vector<DriveCommand> Driver::due(Clock::time_point now, std::int64_t utime, const std::optional<DrivePose>& pose) {
  if (held_ && now - sign_ >= hold_) release();
  if (!busy() || now < next_) return {};
  next_ = now + interval_;
  if (held_) return mapping_.commands(values_, utime, pose);
  --safe_left_;
  return mapping_.commands({}, utime, pose);
}

}  // namespace experiment
