// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/model/joint_type.hpp"
#include "tools/shoal/urdf/robot_description.hpp"

namespace tools {

/// Keys of a map of the vehicle file and their values as YAML, in order.
using YamlEntries = std::vector<std::pair<std::string, std::string>>;

/// Part of a body: a shape of the file in the body's frame B.
struct ImportedPart {
  RobotShape shape;  ///< its X_LS is not used
  sim::Pose X_BP = sim::Pose::Identity();
  bool only_visual = false;  ///< collides with nothing
};

/// Links joined by fixed joints; the frame B is that of the first of these links.
struct ImportedBody {
  std::string name;
  sim::Pose X_VB = sim::Pose::Identity();
  double mass_kg = 0;
  sim::Vector3d center_of_mass_m = sim::Vector3d::Zero();  ///< in B
  sim::Matrix3d inertia_kgm2 = sim::Matrix3d::Zero();      ///< about the center of mass, in axes of B
  bool lacks_mass = false;     ///< its mass is not known: complete_masses() sets it, and the inertia
  bool lacks_inertia = false;  ///< its inertia is not known: complete_masses() sets it
  std::vector<ImportedPart> parts;
  YamlEntries water;  ///< coefficients of `hydrodynamics`, about the origin of B in its axes; empty: `model: none`
  sim::SourcePlace place;
};

/// Joint between two bodies; `second` is `world` for a body that the file attaches to its link `world`.
struct ImportedJoint {
  std::string name;
  sim::JointType type = sim::JointType::hinge;
  std::string first, second;
  sim::Vector3d axis_V = sim::Vector3d::UnitX();
  std::optional<sim::Vector3d> axis2_V;            ///< universal
  std::optional<sim::Vector3d> anchor_V;           ///< unset: the origin of the child
  std::optional<double> low_stop, high_stop;       ///< rad or m
  std::optional<double> servo_low, servo_high;     ///< rad or m
  std::optional<double> max_velocity, max_effort;  ///< both set: it gets a servo, unless it follows another joint
  std::optional<double> max_acceleration;
  double damping = 0, friction = 0;   ///< N m s/rad or N s/m; N m or N
  std::optional<RobotMimic> follows;  ///< the joint that it follows, by its name in the vehicle file
  bool has_device = false;            ///< one of ImportedVehicle::devices drives it
  sim::SourcePlace place;
  bool has_servo() const { return max_velocity && max_effort && !follows && !has_device; }
};

/// Device that the file describes.
struct ImportedDevice {
  std::string name, type;
  std::string body;  ///< empty: the first body
  sim::Pose X_BS = sim::Pose::Identity();
  YamlEntries keys;  ///< those of its type
};

/// Where a link is in the vehicle.
struct LinkPlace {
  std::string body;  ///< empty: it is the world, or was left out
  sim::Pose X_BL = sim::Pose::Identity();
};

/// A robot in the terms of a vehicle file.
struct ImportedVehicle {
  std::string name;
  std::string source;                ///< file that it was imported from
  std::string format = "urdf";       ///< of the source, as `shoal import` names it
  std::vector<std::string> comment;  ///< lines before the root element of the source
  std::vector<ImportedBody> bodies;  ///< the first is the root
  std::vector<ImportedJoint> joints;
  std::vector<ImportedDevice> devices;
  std::map<std::string, LinkPlace> links;          ///< by their names in the source
  std::map<std::string, std::string> joint_names;  ///< in the vehicle file, by those in the source
  std::vector<ImportNote> notes;
};

/// Free: the root link moves.  Fixed: a joint fixes it to the world; it then needs no mass.
enum class Base { free, fixed };

/// Treatment of a body without mass: it is refused, or complete_masses() gives it one.
enum class NoMass { refused, of_shapes };

/// Makes bodies and joints of a checked robot: fixed joints are merged into the body of their parent, and names become
/// those that Shoal accepts.  A root link `world` without mass and shapes is the world, as is one from which a floating
/// or planar joint leads.  An end without mass and shapes is left out.  Throws sim::ConfigError for a body without mass
/// or with an impossible inertia.
ImportedVehicle vehicle_of(const RobotDescription& robot, const std::string& file_name, Base base = Base::free,
                           NoMass no_mass = NoMass::refused);

/// Names of the bodies that a joint connects; `parent` may be `world`.
struct JointEnds {
  std::string parent, child;
};

/// Makes a joint of a vehicle file.  X_VJ: the joint's frame in the vehicle's frame.
ImportedJoint imported_joint(const RobotJoint& from, const std::string& name, const JointEnds& ends,
                             const sim::Pose& X_VJ, std::vector<ImportNote>& notes);

}  // namespace tools
