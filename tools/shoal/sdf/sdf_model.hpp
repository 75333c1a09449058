// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/shoal/sdf/sdf_frames.hpp"
#include "tools/shoal/urdf/robot_description.hpp"

namespace tools {

/// A `<joint>` as it stands in the file, with full names.
struct SdfJoint {
  RobotJoint joint;   ///< parent and child: full names of frames, after resolve_joints() of links
  std::string frame;  ///< of the joint
  sim::Vector3d axis = sim::Vector3d::Zero(), axis2 = sim::Vector3d::Zero();  ///< in the frames below; of any length
  std::string axis_frame, axis2_frame;
};

/// A `<sensor>` of a link, or of a joint whose child it measures.
struct SdfSensor {
  XmlElement element;
  std::string link;
  std::string joint;  ///< empty: it is one of a link
  sim::Pose X_LS = sim::Pose::Identity();
};

/// A `<plugin>` of a model.
struct SdfPlugin {
  XmlElement element;
  SdfScope scope;
};

/// `<fluid_added_mass>` of a link: about its origin in its axes, in the order of force, moment.
struct SdfAddedMass {
  std::string link;
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
};

/// A model with those nested in it or included: all names are full ones.
struct SdfModel {
  RobotDescription robot;  ///< its joints are empty
  std::vector<SdfJoint> joints;
  std::vector<SdfSensor> sensors;
  std::vector<SdfPlugin> plugins;
  std::vector<SdfAddedMass> added_masses;
  SdfFrames frames;
  std::string canonical_link;
  bool is_static = false;
};

}  // namespace tools
