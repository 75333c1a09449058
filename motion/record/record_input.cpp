// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/record_input.hpp"

#include <unistd.h>

#include <string_view>

#include "experiment/drive/drive_profile.hpp"

namespace motion {

namespace {

/// A key that comes again after less than this is held, and repeated by the terminal.
constexpr std::chrono::milliseconds repeat_interval{80};

/// Names of the keys of a keyboard by their codes, 1 to 57 (linux/input-event-codes.h); empty: not used.
constexpr const char* key_names[] = {"",  "escape", "1",         "2",   "3",     "4", "5", "6",  "7", "8",    "9", "0",
                                     "-", "=",      "backspace", "tab", "q",     "w", "e", "r",  "t", "y",    "u", "i",
                                     "o", "p",      "[",         "]",   "enter", "",  "a", "s",  "d", "f",    "g", "h",
                                     "j", "k",      "l",         ";",   "'",     "`", "",  "\\", "z", "x",    "c", "v",
                                     "b", "n",      "m",         ",",   ".",     "/", "",  "",   "",  "space"};
constexpr std::uint16_t first_button = 256;

std::string name_of(std::uint16_t code) {
  switch (code) {
    case 103:
      return "up";
    case 105:
      return "left";
    case 106:
      return "right";
    case 108:
      return "down";
    default:
      return code < std::size(key_names) ? key_names[code] : "";
  }
}

void write_to_terminal(std::string_view text) {
  if (::write(STDERR_FILENO, text.data(), text.size()) < 0) return;  // the terminal is gone
}

}  // namespace

bool is_key_name(const std::string& name) {
  if (name.size() == 1) return name[0] > ' ' && name[0] <= '~';
  const std::string words = std::string(", ") + key_words + ",";
  return name.find_first_of(" ,") == std::string::npos && words.find(" " + name + ",") != std::string::npos;
}

void take_event(const experiment::InputEvent& event, JointCommands& commands) {
  switch (event.type) {
    case experiment::InputEvent::report:
      // Which keys are held is unknown.
      if (event.code == experiment::InputEvent::report_dropped) commands.release_all();
      break;
    case experiment::InputEvent::button:
      if (event.value == 2) break;
      if (event.code >= first_button)
        commands.button(event.code, event.value != 0);
      else if (const std::string name = name_of(event.code); !name.empty())
        commands.key(name, event.value != 0);
      break;
    case experiment::InputEvent::axis:
      commands.axis(event.code, event.value);
      break;
    default:
      break;
  }
}

TerminalInput::TerminalInput(bool is_silent) : is_silent_(is_silent) {
  if (!is_silent_) write_to_terminal(experiment::KeyEvents::query);
}

TerminalInput::~TerminalInput() {
  if (is_reporting_) write_to_terminal(experiment::KeyEvents::end_reports);
}

void TerminalInput::take(const experiment::KeyEvent& event, JointCommands& commands) {
  if (event.ctrl) {
    // A raw terminal sends Ctrl-C as a key; it must end the recording in order, not kill it.
    if (event.action == experiment::KeyEvent::Action::press && (event.key == "c" || event.key == "d"))
      commands.key("enter", true);
    return;
  }
  if (is_silent_ || event.action == experiment::KeyEvent::Action::repeat) return;
  if (is_reporting_) return commands.key(event.key, event.action == experiment::KeyEvent::Action::press);
  const Clock::time_point now = Clock::now();
  // A terminal without releases repeats a held key; a repetition must not toggle the joint again.
  const bool is_repeated = event.key == last_key_ && now - last_at_ < repeat_interval;
  last_key_ = event.key;
  last_at_ = now;
  if (!is_repeated) commands.tap(event.key);
}

bool TerminalInput::read(std::int64_t, JointCommands& commands) {
  while (const auto byte = terminal_.next()) {
    const auto event = keys_.next(*byte);
    if (keys_.has_reports() && !is_reporting_ && !is_silent_) {
      write_to_terminal(experiment::KeyEvents::start_reports);
      is_reporting_ = true;
    }
    if (event) take(*event, commands);
  }
  return isatty(STDIN_FILENO) != 0;
}

DeviceInput::DeviceInput(const std::string& path, JointCommands& commands) : path_(path), device_(path) {
  for (const int axis : commands.axes())
    if (const auto range = device_.range(axis)) commands.set_range(axis, range->first, range->second);
}

bool DeviceInput::read(std::int64_t, JointCommands& commands) {
  if (device_.read([&](const experiment::InputEvent& event) { take_event(event, commands); })) return true;
  throw experiment::DriveError(path_ + ": the device is gone");
}

bool EventFileInput::read(std::int64_t until_us, JointCommands& commands) {
  for (; next_ < events_.size() && events_[next_].time_us - events_.front().time_us <= until_us; ++next_)
    take_event(events_[next_], commands);
  return next_ < events_.size();
}

}  // namespace motion
