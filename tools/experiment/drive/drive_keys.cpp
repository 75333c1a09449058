// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/drive/drive_keys.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tools {

std::string DriveKeyNames::next(char byte) {
  const State before = std::exchange(state_, State::none);
  if (byte == 27) {
    state_ = State::escape;
    return {};
  }
  if (before == State::escape && (byte == '[' || byte == 'O')) {
    state_ = State::sequence;
    return {};
  }
  if (before == State::sequence) {
    // Parameters continue; a letter or `~` ends the sequence.
    if (byte >= ' ' && byte <= '?') state_ = State::sequence;
    switch (byte) {
      case 'A':
        return "up";
      case 'B':
        return "down";
      case 'C':
        return "right";
      case 'D':
        return "left";
      default:
        return {};
    }
  }
  if (byte == ' ') return "space";
  if (byte == '\t') return "tab";
  if (byte == '\r' || byte == '\n') return "enter";
  return byte > ' ' && byte < 127 ? std::string{byte} : std::string{};
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

}  // namespace tools
