// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include "sim/config/message_text.hpp"
#include "tools/shoal/urdf/robot_shapes.hpp"
#include "tools/shoal/urdf/urdf_reader.hpp"

namespace tools {

namespace {

/// Reads the color of a material; empty: it has none.
std::string read_color(const XmlElement& material, std::vector<ImportNote>& notes) {
  if (!material.children("texture").empty())
    notes.push_back({material.children("texture").front().place(), "the texture of a material is not imported"});
  const std::vector<XmlElement> colors = material.children("color");
  if (colors.empty()) return "";
  const XmlElement& color = colors.front();
  return color_of(color, "'rgba'", color.text("rgba"), color.any_numbers("rgba"), notes);
}

double read_length(const XmlElement& element, const char* attribute) {
  const double value = element.number(attribute);
  check_length(element, fmt::format("'{}'", attribute), value);
  return value;
}

void read_box(const XmlElement& box, RobotShape& shape) {
  const std::vector<double> size = box.numbers("size", 3);
  for (const double length : size) check_length(box, "'size'", length);
  shape.size_m = {size[0], size[1], size[2]};
}

void read_mesh(const XmlElement& mesh, RobotShape& shape) {
  shape.mesh = mesh.text("filename");
  if (shape.mesh.empty()) mesh.refuse("'filename' must not be empty");
  shape.scale = mesh.vector("scale", sim::Vector3d::Ones());
  shape.place = mesh.place();
}

void read_geometry(const XmlElement& geometry, RobotShape& shape, std::vector<ImportNote>& notes) {
  const std::vector<XmlElement> kinds = geometry.children();
  if (kinds.empty()) geometry.refuse("<geometry> must have a shape");
  if (kinds.size() > 1)
    notes.push_back({kinds[1].place(), fmt::format("{}: only the first element of a <geometry> is imported, <{}>",
                                                   geometry.who(), sim::shortened(sim::printable(kinds[0].name())))});
  const XmlElement& kind = kinds.front();
  shape.place = kind.place();
  const std::string_view word = kind.name();
  if (word == "box") {
    shape.shape = sim::PartShape::box;
    read_box(kind, shape);
  } else if (word == "sphere") {
    shape.shape = sim::PartShape::sphere;
    shape.radius_m = read_length(kind, "radius");
  } else if (word == "cylinder" || word == "capsule") {
    shape.shape = word == "capsule" ? sim::PartShape::capsule : sim::PartShape::cylinder;
    shape.radius_m = read_length(kind, "radius");
    shape.length_m = read_length(kind, "length");
  } else if (word == "mesh") {
    shape.shape = sim::PartShape::mesh;
    read_mesh(kind, shape);
  } else {
    kind.refuse("the shape must be one of: box, capsule, cylinder, mesh, sphere, got <" +
                sim::shortened(sim::printable(word)) + ">");
  }
}

}  // namespace

UrdfColors read_urdf_colors(const XmlElement& robot, std::vector<ImportNote>& notes) {
  UrdfColors colors;
  std::vector<XmlElement> materials = robot.children("material");
  for (const XmlElement& link : robot.children("link"))
    for (const XmlElement& visual : link.children("visual"))
      for (const XmlElement& material : visual.children("material")) materials.push_back(material);
  for (const XmlElement& material : materials) {
    const std::string color = read_color(material, notes);
    if (!color.empty()) colors.try_emplace(material.text("name", ""), color);
  }
  return colors;
}

std::optional<RobotShape> read_urdf_shape(const XmlElement& element, const UrdfColors& colors,
                                          std::vector<ImportNote>& notes) {
  RobotShape shape;
  element.note_others({"origin", "geometry", "material"}, notes);
  shape.name = element.text("name", "");
  shape.X_LS = element.origin();
  read_geometry(element.required_child("geometry"), shape, notes);
  if (!has_volume(shape)) {
    note_no_volume(shape, element.who(), notes);
    return std::nullopt;
  }
  const std::vector<XmlElement> materials = element.children("material");
  if (materials.empty()) return shape;
  const XmlElement& material = materials.front();
  if (materials.size() > 1)
    notes.push_back({materials[1].place(), element.who() + ": only the first <material> of a shape is imported"});
  // The material's own color, else the one of its name; read_urdf_colors() has added the notes.
  std::vector<ImportNote> known_notes;
  shape.color = read_color(material, known_notes);
  if (!shape.color.empty()) return shape;
  const std::string name = material.text("name", "");
  const auto named = colors.find(name);
  if (named != colors.end())
    shape.color = named->second;
  else if (material.children().empty())
    notes.push_back({material.place(), fmt::format("{}: the material '{}' is not defined: its color is not imported",
                                                   element.who(), sim::shortened(sim::printable(name)))});
  return shape;
}

std::optional<RobotShape> read_urdf_visual(const XmlElement& element, const UrdfColors& colors,
                                           std::vector<ImportNote>& notes) {
  return read_or_note(
      element, [&] { return read_urdf_shape(element, colors, notes); }, notes);
}

}  // namespace tools
