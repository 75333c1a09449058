// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/shoal/urdf/urdf_model.hpp"

namespace tools {

/// Parses URDF.  `file_name` is for errors and notes.  Entities of a document type are not expanded.  Throws
/// sim::ConfigError of one line: XML that is not well-formed, xacro, another format, missing or wrong values, joints
/// of a type that Shoal does not have, links that do not form one tree.
UrdfRobot read_urdf(const std::string& text, const std::string& file_name);

/// Reads a file; also throws sim::ConfigError when it is missing, not a file or too large.
UrdfRobot read_urdf_file(const std::string& path);

}  // namespace tools
