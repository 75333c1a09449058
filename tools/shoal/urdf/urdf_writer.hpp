// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/shoal/urdf/robot_description.hpp"

namespace tools {

/// Returns a robot as URDF.  Reading it gives the same numbers, and rotations to the last digits.
std::string urdf_text(const RobotDescription& robot);

}  // namespace tools
