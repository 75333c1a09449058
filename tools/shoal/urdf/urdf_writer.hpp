// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/shoal/urdf/robot_description.hpp"

namespace tools {

/// Returns a robot as URDF.  Numbers are exact: reading them gives the same doubles.
std::string urdf_text(const RobotDescription& robot);

}  // namespace tools
