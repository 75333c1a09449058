// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/drive_keys.hpp"

#include <algorithm>
#include <cmath>

namespace experiment {

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
