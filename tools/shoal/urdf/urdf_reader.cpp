// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_reader.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "sim/config/message_text.hpp"
#include "tools/shoal/urdf/robot_tree.hpp"
#include "tools/shoal/urdf/xml_file.hpp"

namespace tools {

namespace {

/// Refuses xacro elements, which must be expanded first.
void refuse_xacro(const XmlElement& element) {
  for (const XmlElement& child : element.children())
    if (child.name().starts_with("xacro:"))
      child.refuse(fmt::format("<{}> is xacro, not URDF: run `xacro FILE > robot.urdf` first", child.name()));
}

RobotInertial read_inertial(const XmlElement& inertial, std::vector<ImportNote>& notes) {
  RobotInertial read;
  inertial.note_others({"origin", "mass", "inertia"}, notes);
  read.X_LC = inertial.origin();
  const XmlElement mass = inertial.required_child("mass");
  read.mass_kg = mass.number("value");
  if (read.mass_kg < 0) mass.refuse("the mass must be >= 0 kg, got " + sim::number_text(read.mass_kg));
  const XmlElement inertia = inertial.required_child("inertia");
  // Eigen's list of values must not be left by an exception.
  const double xx = inertia.number("ixx"), yy = inertia.number("iyy"), zz = inertia.number("izz");
  const double xy = inertia.optional_number("ixy").value_or(0), xz = inertia.optional_number("ixz").value_or(0),
               yz = inertia.optional_number("iyz").value_or(0);
  read.inertia_kgm2 << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  constexpr double rounding_kgm2 = 1e-15;
  for (int i = 0; i < 3; ++i)
    if (read.inertia_kgm2(i, i) < -rounding_kgm2)
      inertia.refuse("the moments of inertia must be >= 0 kg m^2, got " + sim::number_text(read.inertia_kgm2(i, i)));
  return read;
}

RobotLink read_link(XmlElement element, const UrdfColors& colors, std::vector<ImportNote>& notes) {
  RobotLink link;
  link.name = element.text("name");
  link.place = element.place();
  element.set_who("link '" + sim::shortened(sim::printable(link.name)) + "'");
  refuse_xacro(element);
  element.note_others({"inertial", "visual", "collision"}, notes);
  if (const auto inertial = element.child("inertial")) link.inertial = read_inertial(*inertial, notes);
  for (const XmlElement& shape : element.children("collision"))
    if (auto read = read_urdf_shape(shape, colors, notes)) link.collisions.push_back(std::move(*read));
  for (const XmlElement& shape : element.children("visual"))
    if (auto read = read_urdf_visual(shape, colors, notes)) link.visuals.push_back(std::move(*read));
  return link;
}

}  // namespace

RobotDescription read_urdf(const std::string& text, const std::string& file_name) {
  const XmlFile file(text, file_name, "robot");
  const XmlElement root = file.root();
  RobotDescription robot;
  refuse_xacro(root);
  robot.name = root.text("name", "");
  if (robot.name.empty()) {
    robot.name = std::filesystem::path(file_name).stem().string();
    robot.notes.push_back({root.place(), "the robot has no name: it gets that of the file"});
  }
  robot.comment = file.leading_comment();
  file.note_document_type(robot.notes);
  root.note_others({"link", "joint", "material"}, robot.notes);
  const UrdfColors colors = read_urdf_colors(root, robot.notes);
  for (const XmlElement& link : root.children("link")) robot.links.push_back(read_link(link, colors, robot.notes));
  for (const XmlElement& joint : root.children("joint")) robot.joints.push_back(read_urdf_joint(joint, robot.notes));
  check_counts(robot, root.place());
  add_world(robot);
  drop_unconnected_links(robot);
  check_tree(robot);
  return robot;
}

RobotDescription read_urdf_file(const std::string& path) {
  if (path.ends_with(".xacro")) refuse_file(path, "is xacro, not URDF: run `xacro " + path + " > robot.urdf` first");
  return read_urdf(read_robot_file(path), path);
}

}  // namespace tools
