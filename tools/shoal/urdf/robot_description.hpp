// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/model/part_shape.hpp"

namespace tools {

/// Limits of a file, so that a damaged or hostile one cannot use much time or memory.
inline constexpr std::size_t max_robot_file_bytes = 16u << 20;
inline constexpr std::size_t max_robot_links = 2000;
inline constexpr std::size_t max_robot_shapes = 20000;

/// `<inertial>`: mass, center of mass and inertia about it.
struct RobotInertial {
  sim::Pose X_LC = sim::Pose::Identity();  ///< frame of the inertia, at the center of mass, in the link's frame L
  double mass_kg = 0;
  sim::Matrix3d inertia_kgm2 = sim::Matrix3d::Zero();
};

/// Shape of a `<collision>` or `<visual>`.
struct RobotShape {
  std::string name;
  sim::PartShape shape = sim::PartShape::box;
  sim::Vector3d size_m = sim::Vector3d::Zero();  ///< box
  double radius_m = 0;                           ///< sphere, cylinder, capsule
  double length_m = 0;                           ///< cylinder, capsule (without its caps)
  std::string mesh;                              ///< mesh: file as named in the source
  sim::Vector3d scale = sim::Vector3d::Ones();   ///< mesh
  sim::Pose X_LS = sim::Pose::Identity();        ///< in the link's frame
  std::string color;                             ///< `#rrggbb`; empty: none
  sim::SourcePlace place;
};

struct RobotLink {
  std::string name;
  std::optional<RobotInertial> inertial;
  std::vector<RobotShape> collisions, visuals;
  sim::SourcePlace place;
};

/// Types of joints.  A floating or planar one can only be that of the root; only SDF has `ball` and `universal`.
enum class RobotJointType { fixed, revolute, continuous, prismatic, floating, planar, ball, universal };

/// `<mimic>`: position = multiplier * position of another joint + offset.
struct RobotMimic {
  std::string joint;
  double multiplier = 1, offset = 0;  ///< offset: rad or m
};

struct RobotJoint {
  std::string name;
  RobotJointType type = RobotJointType::fixed;
  std::string parent, child;
  sim::Pose X_PJ = sim::Pose::Identity();          ///< frame of the child, J, in the parent's frame
  sim::Vector3d anchor_J = sim::Vector3d::Zero();  ///< point of the joint; in URDF the origin of the child
  sim::Vector3d axis_J = sim::Vector3d::UnitX();   ///< unit vector
  sim::Vector3d axis2_J = sim::Vector3d::UnitY();  ///< universal: second axis, perpendicular to the first
  std::optional<double> lower, upper;              ///< rad or m
  std::optional<double> max_effort, max_velocity;  ///< N m or N; rad/s or m/s
  std::optional<double> max_acceleration;          ///< rad/s^2 or m/s^2
  std::optional<double> soft_lower, soft_upper;    ///< `<safety_controller>`
  double damping = 0, friction = 0;                ///< N m s/rad or N s/m; N m or N
  std::optional<RobotMimic> mimic;
  bool has_device = false;  ///< a device that the file describes drives it, such as two wheels; it gets no servo
  sim::SourcePlace place;
};

/// Note on something that an import leaves out.
struct ImportNote {
  sim::SourcePlace place;
  std::string text;
};

/// A robot as its URDF or SDF describes it.
struct RobotDescription {
  std::string name;
  sim::Pose X_VR = sim::Pose::Identity();  ///< root link in the vehicle's frame
  std::vector<std::string> comment;        ///< lines of the comments before the root element
  std::vector<RobotLink> links;
  std::vector<RobotJoint> joints;
  std::vector<ImportNote> notes;
};

}  // namespace tools
