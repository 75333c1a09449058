// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>

#include "experiment/drive/drive_profile.hpp"
#include "experiment/drive/input_events.hpp"

namespace experiment {

/// State of a gamepad after its events.
class Gamepad {
 public:
  explicit Gamepad(const DriveProfile::Gamepad& profile) : profile_(profile) {}
  /// Sets the range of an axis, as the device tells it.
  void set_range(int code, double low, double high);
  /// Takes an event.  After events that the kernel dropped the dead-man button counts as released until it is pressed
  /// again.
  void take(const InputEvent& event);
  /// Returns whether the dead-man button is held.
  bool holds() const { return holds_; }
  /// Returns the positions of the axes, with the dead band.
  DriveValues values() const;
  /// Returns, once, whether the button of the next joint was pressed.
  bool take_next_joint();

 private:
  struct Range {
    double low, high;
  };
  DriveProfile::Gamepad profile_;
  std::map<int, Range> ranges_;
  std::map<int, double> positions_;  // as the device reports them
  bool holds_ = false, next_joint_ = false;
};

}  // namespace experiment
