// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_reader.hpp"

#include <spdlog/fmt/fmt.h>
#include <tinyxml2.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "sim/config/message_text.hpp"
#include "tools/shoal/urdf/robot_tree.hpp"
#include "tools/shoal/urdf/xml_element.hpp"

namespace tools {

namespace {

[[noreturn]] void refuse_file(const std::string& file_name, const std::string& text, int line = 0) {
  sim::throw_config_error({sim::intern_file_name(file_name), line, 0}, "", text);
}

/// Lines of the comments before the root element, without blanks around them.
std::vector<std::string> leading_comment(const tinyxml2::XMLDocument& document) {
  std::vector<std::string> lines;
  for (const auto* node = document.FirstChild(); node != nullptr && node->ToElement() == nullptr;
       node = node->NextSibling()) {
    if (node->ToComment() == nullptr) continue;
    std::istringstream text(node->Value());
    for (std::string line; std::getline(text, line);) {
      const std::size_t first = line.find_first_not_of(" \t\r"), last = line.find_last_not_of(" \t\r");
      if (first != std::string::npos) lines.push_back(sim::printable(line.substr(first, last - first + 1)));
    }
  }
  return lines;
}

void note_document_type(const tinyxml2::XMLDocument& document, const std::string* file,
                        std::vector<ImportNote>& notes) {
  for (const auto* node = document.FirstChild(); node != nullptr; node = node->NextSibling()) {
    if (node->ToUnknown() == nullptr) continue;
    notes.push_back({{file, node->GetLineNum(), 0}, "the document type is not read; its entities are not expanded"});
    return;  // other unknown nodes are its definitions
  }
}

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

void check_counts(const RobotDescription& robot, const XmlElement& root) {
  std::size_t shapes = 0;
  for (const RobotLink& link : robot.links) shapes += link.collisions.size() + link.visuals.size();
  if (robot.links.empty()) root.refuse("a robot needs a <link>");
  if (robot.links.size() > max_robot_links)
    root.refuse(fmt::format("a robot must have at most {} links, got {}", max_robot_links, robot.links.size()));
  if (shapes > max_robot_shapes)
    root.refuse(fmt::format("a robot must have at most {} shapes, got {}", max_robot_shapes, shapes));
}

/// Element of the robot; refuses other formats with a hint.
const tinyxml2::XMLElement& root_of(const tinyxml2::XMLDocument& document, const std::string& file_name) {
  const tinyxml2::XMLElement* root = document.RootElement();
  if (root == nullptr) refuse_file(file_name, "has no element: URDF has a <robot>");
  const std::string name = root->Name();
  if (name == "robot") return *root;
  const std::string hint = name == "sdf"                             ? "; this is SDF"
                           : name == "mujoco"                        ? "; this is a model of MuJoCo"
                           : name.find("xacro") != std::string::npos ? "; this is xacro: run `xacro FILE > robot.urdf`"
                                                                     : "";
  refuse_file(file_name, "the root element must be <robot>, got <" + sim::shortened(sim::printable(name)) + ">" + hint,
              root->GetLineNum());
}

}  // namespace

RobotDescription read_urdf(const std::string& text, const std::string& file_name) {
  if (text.size() > max_robot_file_bytes) refuse_file(file_name, "must be at most 16 MiB");
  // Parse the XML.
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    const bool deep = document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED;
    refuse_file(file_name, deep ? "elements are nested too deeply" : "is not well-formed XML", document.ErrorLineNum());
  }
  const std::string* file = sim::intern_file_name(file_name);
  const XmlElement root(root_of(document, file_name), file, "");
  // Read the robot.
  RobotDescription robot;
  refuse_xacro(root);
  robot.name = root.text("name", "");
  if (robot.name.empty()) {
    robot.name = std::filesystem::path(file_name).stem().string();
    robot.notes.push_back({root.place(), "the robot has no name: it gets that of the file"});
  }
  robot.comment = leading_comment(document);
  note_document_type(document, file, robot.notes);
  root.note_others({"link", "joint", "material"}, robot.notes);
  const UrdfColors colors = read_urdf_colors(root, robot.notes);
  for (const XmlElement& link : root.children("link")) robot.links.push_back(read_link(link, colors, robot.notes));
  for (const XmlElement& joint : root.children("joint")) robot.joints.push_back(read_urdf_joint(joint, robot.notes));
  check_counts(robot, root);
  add_world(robot);
  drop_unconnected_links(robot);
  check_tree(robot);
  return robot;
}

RobotDescription read_urdf_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) refuse_file(path, "is a folder, not a file");
  if (!std::filesystem::is_regular_file(path, error)) refuse_file(path, "does not exist");
  if (std::filesystem::file_size(path, error) > max_robot_file_bytes) refuse_file(path, "must be at most 16 MiB");
  if (path.ends_with(".xacro")) refuse_file(path, "is xacro, not URDF: run `xacro " + path + " > robot.urdf` first");
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) refuse_file(path, "cannot be read");
  return read_urdf(text, path);
}

}  // namespace tools
