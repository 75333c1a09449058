// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/known_map/map_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "sim/config/file_access.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/image/image_file.hpp"

namespace autonomy {

namespace {

namespace fs = std::filesystem;

constexpr double max_cells = 16e6;

/// Keys of map_server.
struct MapKeys {
  std::string image, mode = "trinary";
  double resolution = 0.05, occupied_thresh = 0.65, free_thresh = 0.196;
  sim::Vector3d origin = sim::Vector3d::Zero();
  int negate = 0;

  void read(sim::ParamReader& in) {
    in.require("image");
    in.read("image", image, "file of the image, beside this one");
    in.read_one_of("mode", mode, {"trinary"}, "each cell is occupied, free or unknown");
    in.require("resolution");
    in.read("resolution", resolution, sim::between(0.001, 1), "side of a cell, m");
    in.require("origin");
    in.read("origin", origin, sim::between(-1e7, 1e7), "x and y of the lower left corner, m, and its yaw");
    in.read("negate", negate, sim::between(0, 1), "1: white is occupied");
    in.read("occupied_thresh", occupied_thresh, sim::between(0, 1), "cells above it are occupied");
    in.read("free_thresh", free_thresh, sim::between(0, 1), "cells below it are free");
    if (free_thresh > occupied_thresh)
      in.error("free_thresh", fmt::format("'free_thresh' must be at most 'occupied_thresh', {}, got {}",
                                          occupied_thresh, free_thresh));
    if (in.has("origin") && origin.z() != 0) in.error("origin", "'origin' must have yaw 0");
  }
};

std::string found(const std::string& path) {
  std::error_code error;
  if (fs::exists(path, error) || fs::path(path).is_absolute()) return path;
  const fs::path shipped = fs::path(sim::shipped_folder()) / "worlds" / path;
  return fs::exists(shipped, error) ? shipped.string() : path;
}

sim::Image16 levels_of(const std::string& path) {
  constexpr std::uintmax_t max_bytes = 64'000'000;
  std::error_code failed;
  if (!fs::is_regular_file(path, failed)) throw std::invalid_argument(path + ": cannot be read, it is not a file");
  if (const std::uintmax_t bytes = fs::file_size(path, failed); failed || bytes > max_bytes)
    throw std::invalid_argument(fmt::format("{}: must have at most {} bytes, got {}", path, max_bytes, bytes));
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::invalid_argument(path + ": cannot be read");
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  try {
    // The size is checked before the image is decoded: a small file can claim a huge one.
    return sim::decode_png_levels(std::as_bytes(std::span(bytes)), [](std::uint64_t width, std::uint64_t height) {
      if (static_cast<double>(width) * static_cast<double>(height) > max_cells)
        throw sim::ImageError(fmt::format("must have at most {:g} pixels, got {} x {}", max_cells, width, height));
    });
  } catch (const sim::ImageError& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
}

}  // namespace

shoal::occupancy_grid_t read_map_file(const std::string& path) {
  const std::string yaml = found(path);
  MapKeys keys;
  sim::Diagnostics diagnostics;
  const sim::ConfigNode node = sim::load_config_file(yaml, diagnostics);
  if (diagnostics.ok()) {
    sim::ParamReader in(node, "map", diagnostics);
    keys.read(in);
    in.finish();
  }
  if (!diagnostics.ok()) throw std::invalid_argument(diagnostics.lines().front());
  const sim::Image16 image = levels_of((fs::path(yaml).parent_path() / keys.image).string());
  shoal::occupancy_grid_t map{};
  map.cell_m = keys.resolution;
  map.origin_m[0] = keys.origin.x();
  map.origin_m[1] = keys.origin.y();
  map.width = image.width;
  map.height = image.height;
  map.ncells = map.width * map.height;
  map.cells.reserve(image.data.size());
  // The first row of the image is the northernmost.
  for (int row = image.height - 1; row >= 0; --row)
    for (int column = 0; column < image.width; ++column) {
      const double white = *image.at(column, row) / 65535.0, occupied = keys.negate != 0 ? white : 1 - white;
      map.cells.push_back(occupied > keys.occupied_thresh ? 100 : occupied < keys.free_thresh ? 0 : -1);
    }
  return map;
}

}  // namespace autonomy
