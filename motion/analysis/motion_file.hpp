// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "motion/analysis/motion_edit.hpp"
#include "sim/motion/motion.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace motion {

/// Keys above which a motion is written as a file of frames.
constexpr std::size_t max_written_keys = 1000;

/// Writes a motion, and its frames to a CSV file of the same name beside it.  Either the whole file is replaced, or it
/// is as before.  A motion with many keys is sampled into frames.  Throws EditError, without any change, for a motion
/// that could not be read again; std::runtime_error when a file cannot be written.
void write_motion(const std::string& path, const sim::JointMotion& motion);

/// Throws EditError when a motion could not be read again from a file with its keys and frames as they are, and from
/// the CSV file of the same name with its frames.
void check_readable(const std::string& path, const sim::JointMotion& motion);

/// Returns the CSV file that write_motion() would replace although it does not belong to the motion file; empty: none.
std::string foreign_frames(const std::string& path, const sim::JointMotion& motion);
/// Returns the CSV file beside a motion file if it exists and does not belong to the motion; empty: it does, or there
/// is none.
std::string foreign_frames(const std::string& path);

/// Returns the name of the motion in a file: that of the file, with `_` for characters that a name cannot have.
std::string motion_name_of(const std::string& path);

/// Versions of a motion file before and after edits, in the folder `FILE.history` beside it, with their CSV files.  A
/// CSV file that does not belong to the motion is not touched.
class MotionHistory {
 public:
  explicit MotionHistory(std::string path) : path_(std::move(path)) {}
  /// Replaces the file as write_motion() does, and keeps the present version, to which undo() returns; what could be
  /// redone is dropped.  `operation`: what replaces it, in the words of the command; empty: unknown.
  void replace(const sim::JointMotion& motion, const std::string& operation = "") const;
  /// Go back and forth.  Return the operation that was taken back or done again; empty: unknown.  Throw
  /// std::runtime_error when there is no such version, or a CSV file is in the way.
  std::string undo() const { return move("undo", "redo"); }
  std::string redo() const { return move("redo", "undo"); }
  /// Returns the version to which undo() would return.  Throws std::runtime_error when there is none, ConfigError.
  sim::JointMotion previous() const;

 private:
  std::string move(const std::string& from, const std::string& to) const;
  std::string folder() const { return path_ + ".history"; }

  std::string path_;
};

/// Returns how motions of a vehicle are mirrored, from its joint_group.  Throws EditError when it does not say.
MirrorRule mirror_rule(const sim::VehicleConfig& vehicle);

}  // namespace motion
