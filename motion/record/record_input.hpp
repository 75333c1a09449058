// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "experiment/drive/input_device.hpp"
#include "experiment/terminal/key_events.hpp"
#include "experiment/terminal/terminal_keys.hpp"
#include "motion/record/joint_commands.hpp"

namespace motion {

/// Source of keys and sticks of a recording.
class RecordInput {
 public:
  virtual ~RecordInput() = default;
  /// Passes on what has come until a time since the start, us; returns false at the end of the source.
  virtual bool read(std::int64_t until_us, JointCommands& commands) = 0;
};

/// Keys of the terminal.  Where the terminal has the Kitty keyboard protocol, joints move while their keys are held,
/// any number at the same time; else a key starts and stops its joint.
class TerminalInput final : public RecordInput {
 public:
  /// `is_silent`: keys have no effect, because another source reports them.
  explicit TerminalInput(bool is_silent);
  ~TerminalInput() override;
  bool read(std::int64_t until_us, JointCommands& commands) override;
  bool reports_releases() const { return keys_.has_reports(); }

 private:
  using Clock = std::chrono::steady_clock;
  void take(const experiment::KeyEvent& event, JointCommands& commands);

  bool is_silent_, is_reporting_ = false;
  experiment::TerminalKeys terminal_;
  experiment::KeyEvents keys_;
  std::string last_key_;  ///< a key that is held is repeated
  Clock::time_point last_at_{};
};

/// Keyboard or gamepad at /dev/input/eventX.
class DeviceInput final : public RecordInput {
 public:
  /// Opens the device, and sets the ranges of its axes.  Throws DriveError.
  DeviceInput(const std::string& path, JointCommands& commands);
  /// Throws DriveError when the device is gone.
  bool read(std::int64_t until_us, JointCommands& commands) override;

 private:
  std::string path_;
  experiment::InputDevice device_;
};

/// File of the events of such a device.  The first one comes at the start.
class EventFileInput final : public RecordInput {
 public:
  /// Reads the file.  Throws DriveError.
  explicit EventFileInput(const std::string& path) : events_(experiment::read_input_events(path)) {}
  explicit EventFileInput(std::vector<experiment::InputEvent> events) : events_(std::move(events)) {}
  bool read(std::int64_t until_us, JointCommands& commands) override;

 private:
  std::vector<experiment::InputEvent> events_;
  std::size_t next_ = 0;
};

/// Returns whether a keyboard or a terminal can have a key of this name: a printable ASCII character, or one of
/// key_words.
bool is_key_name(const std::string& name);
/// Names of keys that are not characters.
constexpr const char* key_words = "up, down, left, right, escape, space, tab, enter, backspace";

/// Passes an event of an input device on.  Keys are named by their place on a US keyboard.
void take_event(const experiment::InputEvent& event, JointCommands& commands);

}  // namespace motion
