// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "tools/shoal/urdf/urdf_element.hpp"
#include "tools/shoal/urdf/urdf_model.hpp"

namespace tools {

/// Colors of materials by their names, as `#rrggbb`.
using UrdfColors = std::map<std::string, std::string>;

/// Reads the materials of the robot, and those that visuals define by name.
UrdfColors read_urdf_colors(const UrdfElement& robot, std::vector<UrdfNote>& notes);

/// Reads a `<collision>`.  Nothing, and a note, for a shape without volume.  Throws sim::ConfigError.
std::optional<UrdfShape> read_urdf_shape(const UrdfElement& element, const UrdfColors& colors,
                                         std::vector<UrdfNote>& notes);

/// Reads a `<visual>`.  Nothing, and a note, for one that cannot be read.
std::optional<UrdfShape> read_urdf_visual(const UrdfElement& element, const UrdfColors& colors,
                                          std::vector<UrdfNote>& notes);

}  // namespace tools
