// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/shoal/urdf/imported_vehicle.hpp"

namespace tools {

/// Names of the bodies that a joint connects; `parent` may be `world`.
struct JointEnds {
  std::string parent, child;
};

/// Makes a joint of a vehicle file.  R_VJ: rotation of the joint's frame in the vehicle's frame.
ImportedJoint imported_joint(const UrdfJoint& from, const std::string& name, const JointEnds& ends,
                             const sim::Matrix3d& R_VJ, std::vector<UrdfNote>& notes);

}  // namespace tools
