// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/joint_commands.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace motion {

namespace {

/// Pairs of keys, one above the other on the keyboard.
constexpr const char* usual_pairs[][2] = {{"1", "q"}, {"2", "w"}, {"3", "e"}, {"4", "r"}, {"5", "t"},
                                          {"6", "y"}, {"7", "u"}, {"8", "i"}, {"9", "o"}, {"0", "p"},
                                          {"a", "z"}, {"s", "x"}, {"d", "c"}, {"f", "v"}, {"g", "b"},
                                          {"h", "n"}, {"j", "m"}, {"k", ","}, {"l", "."}, {";", "/"}};
/// Axes of the sticks, up and down first (ABS_Y, ABS_X, ABS_RY, ABS_RX), and whether greater values are down.
constexpr int usual_axes[] = {1, 0, 4, 3};

// Codes of a gamepad (linux/input-event-codes.h): shoulder buttons, select, start; triggers.
constexpr int button_previous = 310, button_next = 311, button_pause = 314, button_finish = 315;
constexpr int left_trigger = 2, right_trigger = 5;
constexpr double trigger_low = 0, trigger_high = 255;
constexpr double trigger_factor = 4;  // of the speed

constexpr double dead_band = 0.1;  // share of the deflection
constexpr double speed_notch = 1.25, min_speed = 0.05, max_speed = 20;

}  // namespace

JointCommands::JointCommands(const devices::JointControls& controls, std::vector<std::string> joints,
                             const std::function<std::optional<std::size_t>(const std::string&)>& find,
                             std::vector<std::string> actions)
    : joints_(std::move(joints)), actions_(std::move(actions)) {
  for (const devices::JointControls::Key& key : controls.keys)
    if (const auto joint = find(key.joint))
      keys_.push_back({*joint, key.plus, key.minus, key.velocity.value_or(controls.velocity)});
  if (keys_.empty()) add_usual_keys(controls.velocity);
  for (const devices::JointControls::Stick& stick : controls.sticks)
    if (const auto joint = find(stick.joint))
      sticks_.push_back(
          {stick.set, *joint, stick.axis, stick.velocity.value_or(controls.velocity), stick.low, stick.high});
  if (sticks_.empty()) add_usual_sticks(controls.velocity);
  for (const Stick& stick : sticks_) {
    if (std::find(sets_.begin(), sets_.end(), stick.set) == sets_.end()) sets_.push_back(stick.set);
    axis_named(stick.axis);
  }
  axis_named(left_trigger);
  axis_named(right_trigger);
}

void JointCommands::add_usual_keys(double velocity) {
  for (std::size_t i = 0; i < std::min(joints_.size(), std::size(usual_pairs)); ++i)
    keys_.push_back({i, usual_pairs[i][0], usual_pairs[i][1], velocity});
}

void JointCommands::add_usual_sticks(double velocity) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const int axis = usual_axes[i % std::size(usual_axes)];
    const bool is_vertical = axis == 1 || axis == 4;
    sticks_.push_back(
        {std::to_string(i / std::size(usual_axes) + 1), i, axis, is_vertical ? -velocity : velocity, -32768, 32767});
  }
}

JointCommands::Axis& JointCommands::axis_named(int code) {
  const auto same = std::find_if(axes_.begin(), axes_.end(), [&](const Axis& one) { return one.code == code; });
  if (same != axes_.end()) return *same;
  return axes_.emplace_back(Axis{code, {}, {}});
}

std::vector<int> JointCommands::axes() const {
  std::vector<int> codes;
  for (const Axis& one : axes_) codes.push_back(one.code);
  return codes;
}

bool JointCommands::wish_of(const std::string& name) {
  if (name == "space")
    wishes_.push_back(RecordWish::pause);
  else if (name == "enter")
    wishes_.push_back(RecordWish::finish);
  else if (name == "backspace")
    wishes_.push_back(RecordWish::back);
  else if (name == "'")
    wishes_.push_back(RecordWish::push);
  else if (name == "tab")
    // Hands may leave the keys for any reason: one key stops all joints.
    release_all();
  else if (name == "=" || name == "+")
    speed_ = std::min(max_speed, speed_ * speed_notch);
  else if (name == "-")
    speed_ = std::max(min_speed, speed_ / speed_notch);
  else
    return false;
  return true;
}

void JointCommands::key(const std::string& name, bool is_down) {
  for (Keys& keys : keys_) {
    if (name == keys.plus) {
      // A press that ends before the next frame must still move the joint, so it is kept beside the present state of
      // the key.
      keys.plus_pressed = keys.plus_pressed || is_down;
      keys.plus_held = is_down;
      return;
    }
    if (name == keys.minus) {
      keys.minus_pressed = keys.minus_pressed || is_down;
      keys.minus_held = is_down;
      return;
    }
  }
  if (!is_down) return;
  const auto action = std::find(actions_.begin(), actions_.end(), name);
  if (action != actions_.end())
    pressed_actions_.push_back(static_cast<std::size_t>(action - actions_.begin()));
  else
    wish_of(name);
}

void JointCommands::tap(const std::string& name) {
  for (Keys& keys : keys_) {
    if (name != keys.plus && name != keys.minus) continue;
    const int direction = name == keys.plus ? 1 : -1;
    keys.tapped = keys.tapped == direction ? 0 : direction;
    return;
  }
  key(name, true);
}

void JointCommands::axis(int code, double position) {
  for (Axis& one : axes_)
    if (one.code == code) one.position = position;
}

void JointCommands::set_range(int code, double low, double high) {
  if (low < high) axis_named(code).range = std::pair{low, high};
}

void JointCommands::button(int code, bool is_down) {
  if (!is_down) return;
  if (code == button_pause) wishes_.push_back(RecordWish::pause);
  if (code == button_finish) wishes_.push_back(RecordWish::finish);
  if (sets_.empty()) return;
  if (code == button_next) set_ = (set_ + 1) % sets_.size();
  if (code == button_previous) set_ = (set_ + sets_.size() - 1) % sets_.size();
}

bool JointCommands::uses(const std::string& key) const {
  for (const char* other : {"space", "enter", "backspace", "tab", "=", "+", "-", "'"})
    if (key == other) return true;
  return std::any_of(keys_.begin(), keys_.end(), [&](const Keys& one) { return key == one.plus || key == one.minus; });
}

void JointCommands::release_all() {
  for (Keys& keys : keys_) {
    keys.plus_held = keys.minus_held = keys.plus_pressed = keys.minus_pressed = false;
    keys.tapped = 0;
  }
  for (Axis& one : axes_) one.position.reset();
}

double JointCommands::deflection(int code, double low, double high) const {
  const auto found = std::find_if(axes_.begin(), axes_.end(), [&](const Axis& one) { return one.code == code; });
  if (found == axes_.end() || !found->position) return 0;
  const std::pair<double, double> range = found->range.value_or(std::pair{low, high});
  return std::clamp((*found->position - range.first) / (range.second - range.first), 0.0, 1.0);
}

std::vector<double> JointCommands::velocities() {
  std::vector<double> velocities(joints_.size(), 0.0);
  for (Keys& keys : keys_) {
    const int held = (keys.plus_held || keys.plus_pressed ? 1 : 0) - (keys.minus_held || keys.minus_pressed ? 1 : 0);
    velocities[keys.joint] += keys.velocity * std::clamp(held + keys.tapped, -1, 1);
    keys.plus_pressed = keys.minus_pressed = false;
  }
  for (const Stick& stick : sticks_) {
    const auto moved =
        std::find_if(axes_.begin(), axes_.end(), [&](const Axis& one) { return one.code == stick.axis; });
    if (stick.set != sets_[set_] || !moved->position) continue;
    const double position = 2 * deflection(stick.axis, stick.low, stick.high) - 1;
    // Beyond the dead band the rest of the way is the whole range.
    const double beyond = std::max(0.0, (std::abs(position) - dead_band) / (1 - dead_band));
    velocities[stick.joint] += stick.velocity * std::copysign(beyond, position);
  }
  const double trigger =
      deflection(right_trigger, trigger_low, trigger_high) - deflection(left_trigger, trigger_low, trigger_high);
  const double factor = speed_ * std::pow(trigger_factor, trigger);
  for (double& velocity : velocities) velocity *= factor;
  return velocities;
}

std::string JointCommands::help() const {
  std::string text = fmt::format("  {:<10} {:<10} {}\n", "plus", "minus", "joint");
  for (const Keys& keys : keys_)
    text += fmt::format("  {:<10} {:<10} {}\n", keys.plus, keys.minus, joints_[keys.joint]);
  return text;
}

}  // namespace motion
