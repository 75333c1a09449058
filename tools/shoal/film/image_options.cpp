// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/film/image_options.hpp"

#include <spdlog/fmt/fmt.h>

#include <charconv>

#include "sim/base/number.hpp"
#include "sim/image/image.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

ImageSize parse_image_size(const std::string& text) {
  ImageSize size;
  const char* end = text.data() + text.size();
  const auto [after_width, width_error] = std::from_chars(text.data(), end, size.width);
  if (width_error != std::errc{} || after_width == end || *after_width != 'x')
    throw CLI::ValidationError("--size", "must be such as 1280x720, got '" + text + "'");
  const auto [after_height, height_error] = std::from_chars(after_width + 1, end, size.height);
  if (height_error != std::errc{} || after_height != end)
    throw CLI::ValidationError("--size", "must be such as 1280x720, got '" + text + "'");
  for (const int side : {size.width, size.height})
    if (side < 1 || side > sim::max_image_side_px)
      throw CLI::ValidationError("--size",
                                 fmt::format("must be 1 to {} pixels a side, got '{}'", sim::max_image_side_px, text));
  return size;
}

void add_visibility_option(CLI::App& command, std::string& text) {
  command
      .add_option("--visibility", text,
                  "distance at which a black target disappears in the water, m: 1 harbor, 10 coast, 60 clearest sea; "
                  "larger values are clearer than any sea. none: invisible water. Default 60")
      ->type_name("M");
}

std::optional<double> parse_visibility(const std::string& text) {
  if (text.empty()) return 60;
  if (text == "none") return std::nullopt;
  const auto meters = sim::exact_number<double>(text);
  if (!meters || !(*meters >= 0.1 && *meters <= 1e6))
    throw CLI::ValidationError("--visibility", "must be from 0.1 to 1e6 m, or none, got '" + text + "'");
  return meters;
}

CLI::Option* add_overlay_option(CLI::App& command, std::string& text) {
  return command
      .add_option("--overlay", text,
                  "trails, paths, ellipses (of a log), pings, rays (of laser scanners), labels and clock; all or none")
      ->type_name("LIST");
}

viewer::OverlayChoice parse_overlay_option(const std::string& text) {
  try {
    return viewer::parse_overlays(text);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError("--overlay", error.what());
  }
}

void add_shapes_option(CLI::App& command, std::string& text) {
  command
      .add_option("--shapes", text,
                  "how bodies look: drawn, collision (with the edges of the parts that collide) or wire (only edges)")
      ->type_name("KIND")
      ->check(one_of({"drawn", "collision", "wire"}).description(""))
      ->capture_default_str();
}

viewer::BodyShapes parse_shapes(const std::string& text) {
  if (text == "wire") return viewer::BodyShapes::wire;
  return text == "collision" ? viewer::BodyShapes::collision : viewer::BodyShapes::drawn;
}

}  // namespace tools
