// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "motion/formats/pose_table.hpp"

namespace motion {

/// A motion as a C table of frames of 8 ms, in packages of four.
struct OpenRTable {
  std::string name;                ///< prefix of its names in C, in lower case
  std::string upper;               ///< the same of its macros
  std::vector<TableJoint> joints;  ///< with their locators, by column
  std::string text;                ///< header file
};

/// Throws sim::ConfigError when the format cannot hold the motion.
OpenRTable open_r_table(const sim::JointMotion& motion, const JointNames& names, const FormatOptions& options,
                        Losses& losses);

}  // namespace motion
