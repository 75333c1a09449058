// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/robot_shapes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "sim/config/message_text.hpp"

namespace tools {

namespace {

constexpr double min_length_m = 1e-6, max_length_m = 1e7;  // of parts in Shoal
constexpr double min_mesh_scale = 1e-9;

/// Brings numbers for red, green, blue and opacity into the range from 0 to 1; empty: they are not 3 or 4 numbers.
std::vector<double> color_numbers(const XmlElement& color, const std::string& what, std::vector<double> rgba,
                                  std::vector<ImportNote>& notes) {
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

}  // namespace

std::string color_of(const XmlElement& color, const std::string& what, const std::string& shown,
                     std::vector<double> rgba, std::vector<ImportNote>& notes) {
  const std::string rule =
      what + " must be four numbers from 0 to 1, got '" + sim::shortened(sim::printable(shown)) + "': ";
  rgba = color_numbers(color, rule, std::move(rgba), notes);
  if (rgba.empty()) return "";
  if (rgba[3] != 1) notes.push_back({color.place(), "the transparency of a material is not imported"});
  const auto level = [&](std::size_t i) { return static_cast<int>(std::lround(255 * rgba[i])); };
  return fmt::format("#{:02x}{:02x}{:02x}", level(0), level(1), level(2));
}

void check_length(const XmlElement& element, const std::string& what, double value) {
  if (value < 0) element.refuse(fmt::format("{} must be > 0, got {}", what, sim::number_text(value)));
  if (value > max_length_m)
    element.refuse(fmt::format("{} must be at most 1e7 m, got {}", what, sim::number_text(value)));
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

void note_no_volume(const RobotShape& shape, const std::string& who, std::vector<ImportNote>& notes) {
  notes.push_back({shape.place, fmt::format("{}: a <{}> without volume is not imported", who,
                                            sim::word_of(sim::part_shape_words, shape.shape))});
}

std::optional<RobotShape> read_or_note(const XmlElement& visual, const std::function<std::optional<RobotShape>()>& read,
                                       std::vector<ImportNote>& notes) {
  try {
    return read();
  } catch (const sim::ConfigError& error) {
    // The error without its place, `FILE:LINE: `.
    const std::string text = error.what();
    const std::size_t place = text.find(": ", visual.place().file->size());
    notes.push_back({visual.place(), text.substr(place + 2) + ": this <visual> is not imported"});
    return std::nullopt;
  }
}

}  // namespace tools
