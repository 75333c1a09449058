// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/view/scene_assets.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "sim/base/state_hash.hpp"
#include "sim/geometry/mesh.hpp"
#include "sim/terrain/terrain.hpp"

namespace bridges {

namespace {

enum AssetKind : std::uint32_t { mesh_asset = 1, grid_asset = 2, image_asset = 3 };

static_assert(std::endian::native == std::endian::little, "assets are little-endian");

/// Writer of numbers into bytes.
class AssetWriter {
 public:
  explicit AssetWriter(AssetKind kind) { add(static_cast<std::uint32_t>(kind)); }
  template <typename Number>
  void add(Number number) {
    const auto* const from = reinterpret_cast<const std::byte*>(&number);
    bytes_.insert(bytes_.end(), from, from + sizeof number);
  }
  sim::Bytes take() { return std::move(bytes_); }

 private:
  sim::Bytes bytes_;
};

sim::Bytes bytes_of(const sim::Mesh& mesh) {
  AssetWriter out(mesh_asset);
  out.add(static_cast<std::uint32_t>(mesh.vertices_m.size()));
  out.add(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const sim::Vector3d& vertex : mesh.vertices_m)
    for (int axis = 0; axis < 3; ++axis) out.add(static_cast<float>(vertex[axis]));
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) out.add(corner);
  return out.take();
}

/// Writes every n-th point of a grid, and always the last of each row and column, so that the border stays.
sim::Bytes bytes_of(const sim::HeightGrid& grid) {
  constexpr double head_bytes = 64;
  const double all = head_bytes + 4.0 * grid.columns * grid.rows;
  int every = 1;
  while (all / every / every > SceneAssets::max_bytes) ++every;
  const int columns = (grid.columns - 1 + every - 1) / every + 1, rows = (grid.rows - 1 + every - 1) / every + 1;
  AssetWriter out(grid_asset);
  out.add(static_cast<std::uint32_t>(columns));
  out.add(static_cast<std::uint32_t>(rows));
  // The spacing of a thinned grid is stretched over its width, so that all cells are equal.
  out.add(static_cast<float>(grid.west_m));
  out.add(static_cast<float>(grid.south_m));
  const double dx = grid.width_m() / (columns - 1), dy = grid.depth_m() / (rows - 1);
  out.add(static_cast<float>(dx));
  out.add(static_cast<float>(dy));
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      out.add(static_cast<float>(every == 1 ? grid.at(column, row)
                                            : grid.facet_height(grid.west_m + column * dx, grid.south_m + row * dy)));
  return out.take();
}

}  // namespace

std::string SceneAssets::keep(const std::string& source, sim::Bytes bytes) {
  if (bytes.empty() || bytes.size() > max_bytes) return hash_of_[source] = "";
  sim::StateHash hash;
  hash.add_bytes(bytes.data(), bytes.size());
  const std::string name = fmt::format("{:016x}", hash.value());
  assets_.emplace(name, std::move(bytes));
  return hash_of_[source] = name;
}

std::string SceneAssets::add_mesh(const sim::PartConfig& part) {
  const std::string path = (std::filesystem::path(part.directory) / part.mesh).string();
  // The scale is part of what is drawn, and so of the name.
  const std::string source = fmt::format("mesh {} {}", part.scale, path);
  if (const auto known = hash_of_.find(source); known != hash_of_.end()) return known->second;
  try {
    const sim::Mesh mesh = sim::load_mesh(path, part.scale);
    const std::size_t size = 12 * (mesh.vertices_m.size() + mesh.triangles.size());
    return keep(source, size > max_bytes ? sim::Bytes() : bytes_of(mesh));
  } catch (const sim::MeshError&) {
    return keep(source, {});
  }
}

std::string SceneAssets::add_terrain(const sim::PartConfig& part) {
  const sim::TerrainConfig& terrain = *part.terrain;
  // All that the heights depend on: terrains that were added over the bus have no place in a file.
  const std::string source = fmt::format(
      "terrain {}/{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", terrain.directory, terrain.file,
      static_cast<int>(terrain.source), static_cast<int>(terrain.origin), static_cast<int>(terrain.holes),
      terrain.cell_m, fmt::join(terrain.size_m, ","), terrain.vertical_scale, terrain.vertical_offset_m,
      terrain.height_min_m, terrain.height_max_m, fmt::join(terrain.map_origin_m, ","), terrain.angle_rad,
      terrain.direction_rad, terrain.amplitude_m, terrain.wavelength_m, terrain.roughness, terrain.seed, part.scale);
  if (const auto known = hash_of_.find(source); known != hash_of_.end()) return known->second;
  try {
    return keep(source, bytes_of(sim::load_terrain(terrain).grid));
  } catch (const sim::TerrainError&) {
    return keep(source, {});
  }
}

std::string SceneAssets::add_image(const sim::TextureConfig& texture) {
  const std::string path = (std::filesystem::path(texture.directory) / texture.file).string();
  // Read once, however many materials show it; a missing or huge one becomes an empty asset, which pages leave out.
  const std::string source = "image " + path;
  if (const auto known = hash_of_.find(source); known != hash_of_.end()) return known->second;
  AssetWriter out(image_asset);
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error || size > max_bytes) return keep(source, {});
  std::ifstream file(path, std::ios::binary);
  for (std::istreambuf_iterator<char> next(file), end; next != end; ++next) out.add(*next);
  return keep(source, out.take());
}

}  // namespace bridges
