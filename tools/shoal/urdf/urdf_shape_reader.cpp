// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_shape_reader.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "sim/config/message_text.hpp"

namespace tools {

namespace {

constexpr double min_length_m = 1e-6, max_length_m = 1e7;  // of parts in Shoal

/// Reads the color of a material; empty: it has none.
std::string read_color(const UrdfElement& material, std::vector<UrdfNote>& notes) {
  if (const auto texture = material.child("texture"))
    notes.push_back({texture->place(), "the texture of a material is not imported"});
  const std::optional<UrdfElement> color = material.child("color");
  if (!color) return "";
  const std::vector<double> rgba = color->numbers("rgba", 4);
  for (const double value : rgba)
    if (!(value >= 0 && value <= 1))
      color->refuse("'rgba' must be four numbers from 0 to 1, got '" + color->text("rgba") + "'");
  if (rgba[3] != 1) notes.push_back({color->place(), "the transparency of a material is not imported"});
  const auto level = [&](std::size_t i) { return static_cast<int>(std::lround(255 * rgba[i])); };
  return fmt::format("#{:02x}{:02x}{:02x}", level(0), level(1), level(2));
}

double read_length(const UrdfElement& element, const char* attribute) {
  const double value = element.positive(attribute);
  if (value < min_length_m || value > max_length_m)
    element.refuse(fmt::format("'{}' must be from 1e-6 to 1e7 m, got {}", attribute, sim::number_text(value)));
  return value;
}

void read_box(const UrdfElement& box, UrdfShape& shape) {
  const std::vector<double> size = box.numbers("size", 3);
  for (const double length : size)
    if (!(length >= min_length_m && length <= max_length_m))
      box.refuse("'size' must be three lengths from 1e-6 to 1e7 m, got '" + box.text("size") + "'");
  shape.size_m = {size[0], size[1], size[2]};
}

void read_mesh(const UrdfElement& mesh, UrdfShape& shape) {
  shape.mesh = mesh.text("filename");
  if (shape.mesh.empty()) mesh.refuse("'filename' must not be empty");
  shape.scale = mesh.vector("scale", sim::Vector3d::Ones());
  const sim::Vector3d size = shape.scale.cwiseAbs();
  if (size.minCoeff() < 1e-9) mesh.refuse("'scale' must not be zero, got '" + mesh.text("scale") + "'");
  shape.place = mesh.place();
}

void read_geometry(const UrdfElement& geometry, UrdfShape& shape) {
  const std::vector<UrdfElement> kinds = geometry.children();
  if (kinds.size() != 1) geometry.refuse(fmt::format("<geometry> must have one shape, got {}", kinds.size()));
  const UrdfElement& kind = kinds.front();
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

UrdfColors read_urdf_colors(const UrdfElement& robot, std::vector<UrdfNote>& notes) {
  UrdfColors colors;
  std::vector<UrdfElement> materials = robot.children("material");
  for (const UrdfElement& link : robot.children("link"))
    for (const UrdfElement& visual : link.children("visual"))
      for (const UrdfElement& material : visual.children("material")) materials.push_back(material);
  for (const UrdfElement& material : materials) {
    const std::string color = read_color(material, notes);
    if (!color.empty()) colors.try_emplace(material.text("name", ""), color);
  }
  return colors;
}

UrdfShape read_urdf_shape(const UrdfElement& element, const UrdfColors& colors, std::vector<UrdfNote>& notes) {
  UrdfShape shape;
  element.note_others({"origin", "geometry", "material"}, notes);
  shape.name = element.text("name", "");
  shape.X_LS = element.origin();
  read_geometry(element.required_child("geometry"), shape);
  const std::optional<UrdfElement> material = element.child("material");
  if (!material) return shape;
  // Its own color, else the one of its name; read_urdf_colors() has added the notes.
  std::vector<UrdfNote> known_notes;
  shape.color = read_color(*material, known_notes);
  if (shape.color.empty()) {
    const auto named = colors.find(material->text("name", ""));
    if (named != colors.end()) shape.color = named->second;
  }
  return shape;
}

}  // namespace tools
