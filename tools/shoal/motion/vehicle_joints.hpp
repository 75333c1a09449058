// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "motion/formats/joint_names.hpp"

namespace tools {

/// Returns the names of the joint servos of a vehicle file, with the lists of `names_file`; empty: of
/// joint_names/NAME.yaml beside the vehicle file or among the shipped ones, where it exists.  Throws sim::ConfigError.
motion::JointNames joint_names_of(const std::string& vehicle_file, const std::string& names_file);

/// Returns the file of the vehicle that a motion names: NAME.yaml beside the motion or among the shipped ones; empty:
/// there is none.
std::string vehicle_file_of(const std::string& vehicle, const std::string& motion_file);

}  // namespace tools
