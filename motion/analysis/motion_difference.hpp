// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "motion/analysis/motion_stage.hpp"
#include "sim/motion/motion.hpp"

namespace motion {

/// How the values of a joint differ between two motions, at the frames of the first one: rad, or m for a slider.
struct JointDifference {
  std::string joint;
  double max = 0, max_at_s = 0, rms = 0;
  std::optional<double> first_at_s;  ///< first frame with more than the tolerance
};

struct MotionDifference {
  double first_end_s = 0, second_end_s = 0;
  std::vector<JointDifference> joints;  ///< of both motions, in the order of the first
  std::vector<std::string> only_first, only_second;
  double max() const;
};

/// Compares two motions up to the end of the longer one; a joint holds after its last key.  `name_of`: name of a joint
/// by name or alias.
MotionDifference difference_of(const sim::JointMotion& first, const sim::JointMotion& second, double tolerance,
                               const std::function<std::string(const std::string&)>& name_of);

/// Place of a vehicle at a time of a motion.
struct CoursePoint {
  double at_s = 0;
  sim::Pose X_WV;
};

/// Plays a motion in a world and returns the place of its vehicle after each step, from the start of the motion to its
/// end; of one that loops, the first round.  Throws ConfigError.
std::vector<CoursePoint> course_of(const StageOptions& options, const sim::JointMotion& motion);

/// Distance between two courses at equal times of the motion, m, up to the end of the shorter one.
struct CourseDifference {
  double max_m = 0, max_at_s = 0, rms_m = 0, end_m = 0, end_at_s = 0;
};
CourseDifference difference_of(const std::vector<CoursePoint>& first, const std::vector<CoursePoint>& second);

}  // namespace motion
