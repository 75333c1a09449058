// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>
#include <string>

#include "motion/formats/motion_format.hpp"

namespace motion {

// A gait is repeated, one row after the other.  Between two rows of a behavior all joints move on a cosine, in as many
// steps as the joint that moves farthest needs at the speed of the row; how long a step takes is not in the file.

constexpr double skill_delay_s = 0.05;  ///< unit of the delay after a row
constexpr double rad_per_deg = std::numbers::pi / 180;

std::string write_opencat(const sim::JointMotion& motion, const JointNames& names, const FormatOptions& options,
                          Losses& losses);
sim::JointMotion read_opencat(const MotionSource& source, Losses& losses);

}  // namespace motion
