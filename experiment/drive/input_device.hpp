// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "bridges/base/file_descriptor.hpp"
#include "experiment/drive/input_events.hpp"

namespace experiment {

/// Keyboard or gamepad at /dev/input/eventX.
class InputDevice {
 public:
  /// Opens the device.  Throws DriveError.
  explicit InputDevice(const std::string& path);
  /// Returns the least and the greatest value of an axis, if the device tells them.
  std::optional<std::pair<double, double>> range(int axis) const;
  /// Passes the events that have arrived on; returns false when the device is gone.  Throws DriveError for bytes that
  /// are not events.
  bool read(const std::function<void(const InputEvent&)>& take);

 private:
  std::string path_;
  bridges::FileDescriptor file_;
  InputEventReader reader_;
};

}  // namespace experiment
