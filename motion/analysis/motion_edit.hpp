// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/motion/motion.hpp"

namespace motion {

/// Values that the frames of a motion may have: about as much CSV as can be read.
constexpr double max_frame_values = 2e7;

/// An edit that cannot be done.
class EditError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How a motion is mirrored: joints whose names start with `left` and `right` are exchanged, and the values of some
/// joints change sign.
struct MirrorRule {
  std::vector<std::pair<std::string, std::string>> swap;
  std::vector<std::string> negate;
};

// Each edit returns the changed motion.  Times are in s.  Segments that an edit cuts are linear between frames
// afterwards; others keep their easing.  Poses, notes and settings are kept.

/// Keeps the part between two times, which then starts at 0.
sim::JointMotion trimmed(const sim::JointMotion& motion, double from_s, double to_s);
/// Removes the part between two times; what follows moves up to `from_s`, at which the values after it hold.
sim::JointMotion without(const sim::JointMotion& motion, double from_s, double to_s);
/// Adds another motion after a pause of `gap_s` > 0.
sim::JointMotion appended(const sim::JointMotion& motion, const sim::JointMotion& other, double gap_s);
/// Adds the joints of another motion, and its changes at their times; one that both have at the same time is kept once.
/// Throws EditError when both have a joint, unless it is replaced.
sim::JointMotion merged(const sim::JointMotion& motion, const sim::JointMotion& other, bool replace);
sim::JointMotion mirrored(const sim::JointMotion& motion, const MirrorRule& rule);
/// Adds the mirrored motion behind it: half a cycle becomes a whole one.
sim::JointMotion with_mirrored_half(const sim::JointMotion& motion, const MirrorRule& rule);
/// Moves joints in time; empty: all.  Throws EditError when a key would come before 0.
sim::JointMotion shifted(const sim::JointMotion& motion, double by_s, const std::vector<std::string>& joints);
/// Multiplies all times.
sim::JointMotion stretched(const sim::JointMotion& motion, double factor);
/// Moves the key at a time, between its neighbors, to another time.
sim::JointMotion retimed(const sim::JointMotion& motion, double at_s, double to_s);
/// Replaces each value, at whole frames, by the mean over `window_s` around it.
sim::JointMotion smoothed(const sim::JointMotion& motion, double window_s);
/// Leaves out keys, such that no value changes by more than `tolerance` rad or m.
sim::JointMotion simplified(const sim::JointMotion& motion, double tolerance);
/// Sets values at a time.
sim::JointMotion with_values(const sim::JointMotion& motion, double at_s, const sim::JointValues& values);
/// Names the values at a time as a pose; replaces one of this name, and with it all keys that name it.
sim::JointMotion with_pose(const sim::JointMotion& motion, const std::string& name, double at_s);

/// Returns the motion with these tracks instead of its keys and frames.  Keys of equal times become one; values that
/// are those of a pose are written by its name.  `time_of`: new time of a key that has a note; negative: none.
sim::JointMotion with_tracks(const sim::JointMotion& motion, std::vector<sim::MotionTrack> tracks,
                             const std::function<double(double)>& time_of);

}  // namespace motion
