// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/drive/gamepad.hpp"
#include "experiment/drive/input_device.hpp"

namespace experiment {

/// Gamepad at /dev/input/eventX.
class GamepadDevice {
 public:
  /// Opens the device and asks it for the ranges of the axes of the profile.  Throws DriveError.
  GamepadDevice(const std::string& path, const DriveProfile::Gamepad& profile, Gamepad& gamepad)
      : device_(path), gamepad_(gamepad) {
    for (const DriveProfile::PadAxis& axis : profile.axes)
      if (const auto range = device_.range(axis.code)) gamepad.set_range(axis.code, range->first, range->second);
  }
  /// Passes the events that have arrived to the gamepad; returns false when the device is gone.  Throws DriveError for
  /// bytes that are not events.
  bool read() {
    return device_.read([this](const InputEvent& event) { gamepad_.take(event); });
  }

 private:
  InputDevice device_;
  Gamepad& gamepad_;
};

}  // namespace experiment
