// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "tools/shoal/urdf/robot_description.hpp"
#include "tools/shoal/urdf/xml_element.hpp"

namespace tools {

/// Parses URDF.  `file_name` is for errors and notes.  Entities of a document type are not expanded.  Throws
/// sim::ConfigError of one line: XML that is not well-formed, xacro, another format, missing or wrong values, joints
/// of a type that Shoal does not have, links that do not form one tree.
RobotDescription read_urdf(const std::string& text, const std::string& file_name);

/// Reads a file; also throws sim::ConfigError when it is missing, not a file or too large.
RobotDescription read_urdf_file(const std::string& path);

/// Reads a `<joint>`.  Throws sim::ConfigError.
RobotJoint read_urdf_joint(XmlElement element, std::vector<ImportNote>& notes);

/// Colors of materials by their names, as `#rrggbb`.
using UrdfColors = std::map<std::string, std::string>;

/// Reads the materials of the robot, and those that visuals define by name.
UrdfColors read_urdf_colors(const XmlElement& robot, std::vector<ImportNote>& notes);

/// Reads a `<collision>`.  Nothing, and a note, for a shape without volume.  Throws sim::ConfigError.
std::optional<RobotShape> read_urdf_shape(const XmlElement& element, const UrdfColors& colors,
                                          std::vector<ImportNote>& notes);

/// Reads a `<visual>`.  Nothing, and a note, for one that cannot be read.
std::optional<RobotShape> read_urdf_visual(const XmlElement& element, const UrdfColors& colors,
                                           std::vector<ImportNote>& notes);

}  // namespace tools
