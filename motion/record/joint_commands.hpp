// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "devices/motion/joint_controls.hpp"

namespace motion {

/// Wish of the person who records, beside the velocities of joints.
enum class RecordWish { pause, finish, back, push };

/// Velocities of joints, from the keys and sticks that are held.
///
/// Keys and axes come in any order and at any time; velocities() takes what has come since its last call as one frame:
/// joints whose keys go down in the same frame start together, and a key that went down and up within a frame moves
/// its joint for this frame.
class JointCommands {
 public:
  /// `joints`: names of the servos of the group; `find`: number of one by name or alias.  `actions`: further keys.
  JointCommands(const devices::JointControls& controls, std::vector<std::string> joints,
                const std::function<std::optional<std::size_t>(const std::string&)>& find,
                std::vector<std::string> actions = {});

  /// Takes a key that goes down or up.
  void key(const std::string& name, bool is_down);
  /// Takes a key of a terminal that reports no releases: it starts its joint, or stops it when it moves this way.
  void tap(const std::string& name);
  /// Takes the position of an axis, in the unit of the device.
  void axis(int code, double position);
  /// Sets the range of an axis, as the device tells it.
  void set_range(int code, double low, double high);
  /// Takes a button of a gamepad.
  void button(int code, bool is_down);
  /// Stops all joints, and forgets what is held.
  void release_all();

  /// Returns the velocity of each joint in this frame, rad/s or m/s.
  std::vector<double> velocities();
  std::vector<RecordWish> take_wishes() { return std::exchange(wishes_, {}); }
  /// Returns the numbers of the actions whose keys went down.
  std::vector<std::size_t> take_actions() { return std::exchange(pressed_actions_, {}); }

  /// Returns whether a key has an effect that is not an action.
  bool uses(const std::string& key) const;
  double speed() const { return speed_; }
  /// Returns the name of the selected set of sticks; empty: there is none, or it has no name.
  std::string set() const { return sets_.empty() ? "" : sets_[set_]; }
  /// Returns the keys of all joints, a line each.
  std::string help() const;
  /// Codes of the axes of all sets and of the triggers.
  std::vector<int> axes() const;

 private:
  struct Keys {
    std::size_t joint;
    std::string plus, minus;
    double velocity;
    bool plus_held = false, minus_held = false, plus_pressed = false, minus_pressed = false;
    int tapped = 0;  ///< direction until the next tap
  };
  struct Stick {
    std::string set;
    std::size_t joint;
    int axis;
    double velocity, low, high;
  };
  struct Axis {
    int code;
    std::optional<double> position;
    std::optional<std::pair<double, double>> range;
  };

  void add_usual_keys(double velocity);
  void add_usual_sticks(double velocity);
  bool wish_of(const std::string& name);
  Axis& axis_named(int code);
  double deflection(int code, double low, double high) const;

  std::vector<std::string> joints_, actions_, sets_;
  std::vector<Keys> keys_;
  std::vector<Stick> sticks_;
  std::vector<Axis> axes_;
  std::size_t set_ = 0;
  double speed_ = 1;
  std::vector<RecordWish> wishes_;
  std::vector<std::size_t> pressed_actions_;
};

}  // namespace motion
