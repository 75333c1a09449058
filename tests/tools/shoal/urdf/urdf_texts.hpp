// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/config/diagnostics.hpp"
#include "tools/shoal/urdf/imported_vehicle.hpp"
#include "tools/shoal/urdf/urdf_reader.hpp"

namespace test {

inline const std::string unit_inertial =
    R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)";

/// A robot, with its content from line 2 on.
inline std::string robot_text(const std::string& content) {
  return "<robot name=\"r\">\n" + content + "</robot>\n";
}

/// A link of 1 kg on one line.
inline std::string link_text(const std::string& name, const std::string& more = "") {
  return "<link name=\"" + name + "\">" + unit_inertial + more + "</link>\n";
}

/// A joint from `a` to `b` on one line.
inline std::string joint_text(const std::string& type, const std::string& more = "") {
  return R"(<joint name="j" type=")" + type + R"("><parent link="a"/><child link="b"/>)" + more + "</joint>\n";
}

/// Links `a` and `b` on lines 2 and 3, and a joint on line 4.
inline std::string pair_text(const std::string& type, const std::string& more = "") {
  return robot_text(link_text("a") + link_text("b") + joint_text(type, more));
}

inline tools::ImportedVehicle imported(const std::string& urdf, tools::Base base = tools::Base::free) {
  return tools::vehicle_of(tools::read_urdf(urdf, "r.urdf"), "r.urdf", base);
}

/// The error of an import; empty: none.
inline std::string import_error(const std::string& urdf) {
  try {
    imported(urdf);
    return {};
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
}

/// Notes of an import, one a line.
inline std::string notes_of(const tools::ImportedVehicle& vehicle) {
  std::string lines;
  for (const tools::ImportNote& note : vehicle.notes) lines += note.place.text() + ": " + note.text + "\n";
  return lines;
}

}  // namespace test
