// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "motion/formats/joint_names.hpp"
#include "sim/motion/motion.hpp"

namespace motion {

/// Losses of a conversion between a motion and a file: one sentence each.
using Losses = std::vector<std::string>;

enum class SkillKind { posture, gait, behavior };

/// Choices of an export or import.
struct FormatOptions {
  std::string name;                ///< of the motion in the file; empty: its own, or the only one
  double loop_step_s = 0;          ///< control step of a player of loops; 0: the file has one cycle
  std::optional<double> at_s;      ///< instant of a posture; unset: the only one
  std::string creator = "Shoal";   ///< of an MTN file
  std::string design;              ///< design label of an MTN file; empty: that of the list of joint names
  double row_s = 0.02;             ///< time of a row of a gait, and of a step between two rows of a behavior
  std::optional<SkillKind> skill;  ///< unset: by the motion
};

/// File that is read.
struct MotionSource {
  std::string_view bytes;
  std::string file;  ///< for errors
  const JointNames& names;
  const FormatOptions& options;
  /// Reads another file that this one names; throws std::runtime_error.  Empty: not possible.
  std::function<std::string(const std::string&)> read_other;
};

/// File of an export.
struct ExportedFile {
  std::string name;  ///< in the folder; empty: the only file of the format
  std::string bytes;
};

/// Format of files with motions of other programs.
struct MotionFormat {
  const char* name;
  const char* meaning;
  std::vector<std::string> endings;  ///< of file names
  std::string_view head;             ///< first bytes of a file; empty: they do not show the format
  const char* list;                  ///< of names of joints, see JointNames
  bool uses_aliases;                 ///< joints without a name in the list have that of their alias
  bool holds_lights = false;         ///< else exports leave them out
  /// Returns the file.  Throws sim::ConfigError when the format cannot hold the motion.  Null: not possible.
  std::string (*write)(const sim::JointMotion& motion, const JointNames& names, const FormatOptions& options,
                       Losses& losses);
  /// Returns the motion; its angles are in rad.  Throws sim::ConfigError with line and column, or the offset of the
  /// byte.  Null: not possible.
  sim::JointMotion (*read)(const MotionSource& source, Losses& losses);
  /// Like `write`, for a format of several files in a folder.
  std::vector<ExportedFile> (*write_folder)(const sim::JointMotion& motion, const JointNames& names,
                                            const FormatOptions& options, Losses& losses) = nullptr;
};

/// Returns all formats, those of most users first.
const std::vector<MotionFormat>& motion_formats();
std::vector<std::string> motion_format_names();
/// Returns the format of this name; null: there is none.
const MotionFormat* find_motion_format(std::string_view name);
/// Returns the format of a file by its first bytes, else by its ending; null: unknown.
const MotionFormat* motion_format_of_file(const std::string& path, std::string_view bytes);

/// Returns the motion as a file, or as the files of a folder, of this format.  Throws sim::ConfigError.
std::vector<ExportedFile> files_of_motion(const MotionFormat& format, const sim::JointMotion& motion,
                                          const JointNames& names, const FormatOptions& options, Losses& losses);
/// Returns the motion as the file of a format that has one.  Throws sim::ConfigError.
std::string bytes_of_motion(const MotionFormat& format, const sim::JointMotion& motion, const JointNames& names,
                            const FormatOptions& options, Losses& losses);
/// Reads a file.  Its name becomes that of the motion where the file has none.  Throws sim::ConfigError.
sim::JointMotion motion_of_bytes(const MotionFormat& format, const MotionSource& source, Losses& losses);

/// Throws sim::ConfigError: `motion 'wave': <text>`.
[[noreturn]] void refuse_motion(const sim::JointMotion& motion, const std::string& text);

// Each format.
MotionFormat csv_format();
MotionFormat webots_format();
MotionFormat mtn_format();
MotionFormat mot_format();
MotionFormat pos_format();
MotionFormat ros_format();
MotionFormat play_motion2_format();
MotionFormat opencat_format();
MotionFormat open_r_table_format();
MotionFormat open_r_object_format();

/// Throws sim::ConfigError at the place when a motion file cannot hold the name of a joint.  `who`: the part of the
/// file.
void check_joint_name(std::string_view name, const sim::SourcePlace& place, const std::string& who = "");

/// Returns the joint of the vehicle that a file calls `foreign`; without a vehicle the same name.  Throws
/// sim::ConfigError at the place when the vehicle has none, or a motion file cannot hold the name.
std::string joint_called(const MotionSource& source, const char* list, const std::string& foreign,
                         const sim::SourcePlace& place);

/// Returns a name for a motion: letters, digits, '_' and '-' of the text, '_' for others.
std::string motion_name(std::string_view text);

/// Adds what files of a format never hold: description, notes, loop, changes, start, names of poses.
struct Keeps {
  bool notes = false, loop = false, start = false, description = false;
};
void list_losses(const sim::JointMotion& motion, const Keeps& keeps, Losses& losses);

}  // namespace motion
