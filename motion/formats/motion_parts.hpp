// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "motion/formats/motion_format.hpp"

namespace motion {

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
