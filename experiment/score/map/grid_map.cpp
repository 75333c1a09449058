// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/map/grid_map.hpp"

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "sim/image/image_file.hpp"

namespace experiment {

sim::Image8 map_image(const GridMap& map) {
  sim::Image8 image(map.frame.width, map.frame.height, 1);
  for (int row = 0; row < map.frame.height; ++row)
    for (int column = 0; column < map.frame.width; ++column) {
      const Cell cell = map.cells[map.frame.index(column, row)];
      *image.at(column, map.frame.height - 1 - row) = cell == Cell::occupied ? 0 : cell == Cell::free ? 254 : 205;
    }
  return image;
}

std::string map_yaml(const GridMap& map, const std::string& image) {
  std::string quoted = "'";
  for (const char c : image) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  // 205 is 0.196 occupied, and neither: https://wiki.ros.org/map_server.
  return fmt::format(
      "image: {}'\nmode: trinary\nresolution: {}\norigin: [{}, {}, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"
      "free_thresh: 0.196\n",
      quoted, map.frame.cell_m, map.frame.origin_x_m, map.frame.origin_y_m);
}

std::string write_map(const std::string& path, const GridMap& map) {
  try {
    sim::write_image(path, map_image(map));
  } catch (const sim::ImageError& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  const std::filesystem::path yaml = std::filesystem::path(path).replace_extension(".yaml");
  std::ofstream file(yaml, std::ios::binary);
  file << map_yaml(map, std::filesystem::path(path).filename().string());
  if (!file.flush()) throw std::runtime_error(yaml.string() + ": cannot be written");
  return yaml.string();
}

}  // namespace experiment
