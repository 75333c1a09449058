// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/driver.hpp"

#include <algorithm>
#include <cmath>

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

DriveKeys::Effect DriveKeys::press(const std::string& key) {
  if (key.empty()) return Effect::none;
  if (key == keys_.hold) return Effect::sign_of_life;
  if (key == keys_.next_joint) return Effect::next_joint;
  if (key == keys_.centre) {
    centre();
    return Effect::none;
  }
  for (const DriveProfile::Key& step : keys_.steps) {
    if (key != step.key) continue;
    double& value = values_[std::string(sim::word_of(drive_axis_words, step.axis))];
    value = std::clamp(value + step.step, -1.0, 1.0);
    if (std::abs(value) < 1e-9) value = 0;  // steps there and back
    return Effect::sign_of_life;
  }
  return Effect::none;
}

}  // namespace experiment
