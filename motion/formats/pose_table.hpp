// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "motion/formats/motion_format.hpp"

namespace motion {

/// Joint of a table of poses.
struct TableJoint {
  std::string joint;    ///< in the motion
  std::string foreign;  ///< in the file
};

/// Poses of all joints at instants; between them the values are linear.
struct PoseTable {
  std::vector<TableJoint> joints;
  std::vector<double> times_s;            ///< increase
  std::vector<std::vector<double>> rows;  ///< by time, then by joint: rad or m
  std::vector<std::string> notes;         ///< by time

  double end_s() const { return times_s.back(); }
  /// Returns the tracks of its joints under the names of the motion.
  std::vector<sim::MotionTrack> tracks() const;
};

/// Requirements on a table.
struct TableRules {
  double tick_s = 0;  ///< times are whole multiples of it; 0: any
  std::size_t max_rows = sim::max_motion_keys;
  double max_value = 1e6;  ///< rad or m
  bool holds_sliders = true;
  bool keeps_notes = false;
  bool samples_easing = true;  ///< false: only keys, the path between them is the concern of the caller
};

/// Returns poses whose linear interpolation is the motion.  Parts with easing are sampled at the frames of the motion,
/// and keys between two ticks are replaced by poses at both; `losses` has how far this is from the motion.  Joints have
/// the names of the format, its order when its list is complete, and those without a name there are left out.  What
/// no table holds (loop, changes, ...) is added to `losses`.  Throws sim::ConfigError.
PoseTable pose_table(const sim::JointMotion& motion, const JointNames& names, const MotionFormat& format,
                     const TableRules& rules, Losses& losses);

}  // namespace motion
