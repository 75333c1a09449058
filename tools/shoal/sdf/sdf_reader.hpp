// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/shoal/sdf/sdf_files.hpp"
#include "tools/shoal/sdf/sdf_model.hpp"
#include "tools/shoal/urdf/imported_vehicle.hpp"

namespace tools {

/// Reads the model of a file, SDF 1.4 to 1.12; that of a world by its name, which may be empty when there is only one.
/// The files must live as long as the model.  Throws sim::ConfigError of one line.
SdfModel read_sdf(SdfFiles& files, const std::string& path, const std::string& model_name);

/// Reads a `<link>`; its poses may name frames of the model.  Its sensors and added mass are added to the model.
RobotLink read_sdf_link(const XmlElement& element, const SdfScope& scope, SdfModel& model);

/// Reads a `<joint>`.  `version`: 4 is 1.4.  Nothing, and a note, for a type that Shoal does not have.
std::optional<SdfJoint> read_sdf_joint(XmlElement element, const SdfScope& scope, int version, SdfModel& model);

/// Pose of an element of a link, such as a collision, in the frame of the link.
sim::Pose pose_in_link(const XmlElement& element, const std::string& link, const SdfScope& scope, SdfModel& model);

/// Replaces the frames that joints name by the links that these move with.  Throws sim::ConfigError.
void resolve_joints(SdfModel& model);

/// Makes the tree of a model: joints lead away from the world, else from `root` or the canonical link, and one that
/// closes a loop is left out.  Links without `<inertial>` get their masses, unless these are those of shapes.  Throws
/// sim::ConfigError.
RobotDescription robot_of(SdfModel& model, const std::string& root, NoMass no_mass);

/// Adds a note with the reason for each child that is none of these.
void note_rest(const XmlElement& element, std::initializer_list<std::string_view> known,
               std::vector<ImportNote>& notes);

}  // namespace tools
