// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "sim/config/message_text.hpp"
#include "tools/shoal/urdf/urdf_reader.hpp"

namespace tools {

namespace {

constexpr double min_length_m = 1e-6, max_length_m = 1e7;  // of parts in Shoal
constexpr double min_mesh_scale = 1e-9;

/// Brings numbers for red, green, blue and opacity into the range from 0 to 1; empty: they are not 3 or 4 numbers.
std::vector<double> color_numbers(const XmlElement& color, std::vector<ImportNote>& notes) {
  std::vector<double> rgba = color.any_numbers("rgba");
  const std::string what =
      "'rgba' must be four numbers from 0 to 1, got '" + sim::shortened(sim::printable(color.text("rgba"))) + "': ";
  const bool is_color = rgba.size() == 3 || rgba.size() == 4;
  const auto outside = [](double value) { return !(value >= 0 && value <= 1); };
  if (!is_color) {
    notes.push_back({color.place(), what + "the color is not imported"});
    return {};
  }
  constexpr double surely_of_255 = 2;
  if (*std::max_element(rgba.begin(), rgba.begin() + 3) > surely_of_255) {
    notes.push_back({color.place(), what + "it is taken as numbers up to 255"});
    for (std::size_t i = 0; i < rgba.size(); ++i)
      if (i < 3 || rgba[i] > 1) rgba[i] /= 255;
  } else if (std::any_of(rgba.begin(), rgba.end(), outside)) {
    notes.push_back({color.place(), what + "it is limited to this range"});
  } else if (rgba.size() == 3) {
    notes.push_back({color.place(), what + "it is opaque"});
  }
  rgba.resize(4, 1);
  for (double& value : rgba) value = std::clamp(value, 0.0, 1.0);
  return rgba;
}

/// Reads the color of a material; empty: it has none.
std::string read_color(const XmlElement& material, std::vector<ImportNote>& notes) {
  if (!material.children("texture").empty())
    notes.push_back({material.children("texture").front().place(), "the texture of a material is not imported"});
  const std::vector<XmlElement> colors = material.children("color");
  if (colors.empty()) return "";
  const std::vector<double> rgba = color_numbers(colors.front(), notes);
  if (rgba.empty()) return "";
  if (rgba[3] != 1) notes.push_back({colors.front().place(), "the transparency of a material is not imported"});
  const auto level = [&](std::size_t i) { return static_cast<int>(std::lround(255 * rgba[i])); };
  return fmt::format("#{:02x}{:02x}{:02x}", level(0), level(1), level(2));
}

void check_length(const XmlElement& element, const char* attribute, double value) {
  if (value < 0) element.refuse(fmt::format("'{}' must be > 0, got {}", attribute, sim::number_text(value)));
  if (value > max_length_m)
    element.refuse(fmt::format("'{}' must be at most 1e7 m, got {}", attribute, sim::number_text(value)));
}

double read_length(const XmlElement& element, const char* attribute) {
  const double value = element.number(attribute);
  check_length(element, attribute, value);
  return value;
}

void read_box(const XmlElement& box, RobotShape& shape) {
  const std::vector<double> size = box.numbers("size", 3);
  for (const double length : size) check_length(box, "size", length);
  shape.size_m = {size[0], size[1], size[2]};
}

bool has_volume(const RobotShape& shape) {
  const auto is_length = [](double value) { return value >= min_length_m; };
  switch (shape.shape) {
    case sim::PartShape::box:
      return is_length(shape.size_m.minCoeff());
    case sim::PartShape::sphere:
      return is_length(shape.radius_m);
    case sim::PartShape::cylinder:
    case sim::PartShape::capsule:
      return is_length(shape.radius_m) && is_length(shape.length_m);
    default:
      return shape.scale.cwiseAbs().minCoeff() >= min_mesh_scale;
  }
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
    notes.push_back({shape.place, fmt::format("{}: a <{}> without volume is not imported", element.who(),
                                              sim::word_of(sim::part_shape_words, shape.shape))});
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
  try {
    return read_urdf_shape(element, colors, notes);
  } catch (const sim::ConfigError& error) {
    // The error without its place, `FILE:LINE: `.
    const std::string text = error.what();
    const std::size_t place = text.find(": ", element.place().file->size());
    notes.push_back({element.place(), text.substr(place + 2) + ": this <visual> is not imported"});
    return std::nullopt;
  }
}

}  // namespace tools
