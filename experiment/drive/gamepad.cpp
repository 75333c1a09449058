// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/gamepad.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace experiment {

void Gamepad::set_range(int code, double low, double high) {
  if (low < high) ranges_[code] = {low, high};
}

void Gamepad::take(const InputEvent& event) {
  switch (event.type) {
    case InputEvent::report:
      if (event.code == InputEvent::report_dropped) holds_ = false;
      break;
    case InputEvent::button:
      // A repetition (2) does not press a button that counts as released.
      if (event.code == profile_.hold && event.value != 2) holds_ = event.value == 1;
      if (event.code == profile_.next_joint && event.value == 1) next_joint_ = true;
      break;
    case InputEvent::axis:
      for (const DriveProfile::PadAxis& axis : profile_.axes)
        if (axis.code == event.code) positions_[event.code] = event.value;
      break;
    default:
      break;
  }
}

DriveValues Gamepad::values() const {
  DriveValues values;
  for (const DriveProfile::PadAxis& axis : profile_.axes) {
    const auto position = positions_.find(axis.code);
    if (position == positions_.end()) continue;
    const auto reported = ranges_.find(axis.code);
    const Range range = reported == ranges_.end() ? Range{axis.low, axis.high} : reported->second;
    const double deflection = std::clamp(2 * (position->second - range.low) / (range.high - range.low) - 1, -1.0, 1.0);
    // Beyond the dead band the rest of the way is the whole range.
    const double beyond = std::max(0.0, (std::abs(deflection) - profile_.dead_band) / (1 - profile_.dead_band));
    double& value = values[std::string(sim::word_of(drive_axis_words, axis.axis))];
    value = std::clamp(value + std::copysign(beyond, deflection) * axis.scale, -1.0, 1.0);
  }
  return values;
}

bool Gamepad::take_next_joint() {
  return std::exchange(next_joint_, false);
}

}  // namespace experiment
