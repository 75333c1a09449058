// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bridges/base/file_descriptor.hpp"
#include "tools/experiment/drive/gamepad.hpp"

namespace tools {

/// Gamepad at /dev/input/eventX.
class GamepadDevice {
 public:
  /// Opens the device and asks it for the ranges of the axes of the profile.  Throws DriveError.
  GamepadDevice(const std::string& path, const DriveProfile::Gamepad& profile, Gamepad& gamepad);
  /// Passes the events that have arrived to the gamepad; returns false when the device is gone.  Throws DriveError for
  /// bytes that are not events.
  bool read();

 private:
  std::string path_;
  bridges::FileDescriptor file_;
  InputEventReader reader_;
  Gamepad& gamepad_;
};

}  // namespace tools
