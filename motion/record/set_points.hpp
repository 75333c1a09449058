// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "devices/motion/joint_limits.hpp"

namespace motion {

/// Set points of the joints of a group, which follow velocities frame by frame and keep the limits of the servos and
/// those of pairs of joints.
class SetPoints {
 public:
  /// Limits of a servo, rad or m, and per s.
  struct Limits {
    double low, high, velocity;
  };
  /// Value that a joint has to reach in a time, so that what follows starts without a jump.
  struct Goal {
    double value, in_s;
  };

  SetPoints(std::vector<Limits> limits, devices::JointLimitTable pairs, double frame_s)
      : limits_(std::move(limits)),
        pairs_(std::move(pairs)),
        frame_s_(frame_s),
        values_(limits_.size(), 0.0),
        reach_(limits_.size()),
        at_limit_(limits_.size(), false) {}

  std::span<const double> values() const { return values_; }
  /// Sets the value of a joint that something else moves.
  void set(std::size_t joint, double value) {
    values_[joint] = value;
    reach_[joint].reset();
  }
  /// Moves a joint for one frame.
  void move(std::size_t joint, double velocity, const std::optional<Goal>& goal);
  /// Returns whether the joint is at a limit of its servo, or of two joints, which its last movement would pass.
  bool is_at_limit(std::size_t joint) const { return at_limit_[joint]; }
  /// Keeps the limits of pairs for these joints, after all have been moved.  No joint is faster than its servo for it:
  /// while a joint is on its way into a new range, those on which this range depends wait.  Only a joint that something
  /// else moves, or that has to reach its goal, does not wait; then the other one jumps.
  void limit(std::span<const std::size_t> joints);

 private:
  /// Values that a joint can have in this frame.
  struct Reach {
    double before, low, high;
  };

  bool find_limited(std::span<const std::size_t> joints);
  bool is_too_fast(std::size_t joint) const;
  bool let_wait(std::span<const std::size_t> joints, std::size_t joint);

  std::vector<Limits> limits_;
  devices::JointLimitTable pairs_;
  double frame_s_;
  std::vector<double> values_, limited_, desired_;
  std::vector<std::optional<Reach>> reach_;  ///< of the joints that have been moved in this frame
  std::vector<bool> at_limit_, waits_;
};

}  // namespace motion
