// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/shoal/urdf/urdf_element.hpp"
#include "tools/shoal/urdf/urdf_model.hpp"

namespace tools {

/// Reads a `<joint>`.  Throws sim::ConfigError.
UrdfJoint read_urdf_joint(UrdfElement element, std::vector<UrdfNote>& notes);

}  // namespace tools
