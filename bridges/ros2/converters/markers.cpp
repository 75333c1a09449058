// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converters/markers.hpp"

#include <algorithm>
#include <cstring>

#include "bridges/ros2/converters/common_parts.hpp"

namespace bridges::ros2 {
namespace {

constexpr std::uint32_t mesh_asset = 1, grid_asset = 2;

/// Reader of the little-endian numbers of an asset; zero after the end.
class AssetReader {
 public:
  explicit AssetReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  template <class T>
  T number() {
    T value{};
    if (bytes_.size() < sizeof value) return value;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
    return value;
  }
  std::size_t left() const { return bytes_.size(); }
  /// Returns the number at a position after what was read.
  float height(std::size_t index) const {
    float value = 0;
    std::memcpy(&value, bytes_.data() + index * sizeof value, sizeof value);
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

std::vector<sim::Vector3d> triangles_of_mesh(AssetReader in) {
  const std::size_t vertices = in.number<std::uint32_t>(), triangles = in.number<std::uint32_t>();
  // Viewers slow down with larger meshes; a damaged asset must not be read beyond its end.
  if (triangles > max_marker_triangles || in.left() != 12 * (vertices + triangles)) return {};
  std::vector<sim::Vector3d> vertices_m(vertices), corners;
  for (sim::Vector3d& vertex : vertices_m)
    for (int axis = 0; axis < 3; ++axis) vertex[axis] = in.number<float>();
  corners.reserve(3 * triangles);
  for (std::size_t i = 0; i < 3 * triangles; ++i) {
    const std::size_t corner = in.number<std::uint32_t>();
    if (corner >= vertices) return {};
    corners.push_back(vertices_m[corner]);
  }
  return corners;
}

/// Takes evenly spaced rows and columns, with the border.
std::vector<sim::Vector3d> triangles_of_grid(AssetReader in) {
  // Head
  const std::size_t columns = in.number<std::uint32_t>(), rows = in.number<std::uint32_t>();
  const double west_m = in.number<float>(), south_m = in.number<float>();
  const double dx_m = in.number<float>(), dy_m = in.number<float>();
  if (columns < 2 || rows < 2 || columns > in.left() || rows > in.left() || in.left() != 4 * columns * rows) return {};

  // Two triangles for each cell
  const std::size_t across = std::min(columns, max_marker_grid), along = std::min(rows, max_marker_grid);
  const auto corner = [&](std::size_t i, std::size_t k) {
    const std::size_t column = i * (columns - 1) / (across - 1), row = k * (rows - 1) / (along - 1);
    return sim::Vector3d(west_m + static_cast<double>(column) * dx_m, south_m + static_cast<double>(row) * dy_m,
                         in.height(row * columns + column));
  };
  std::vector<sim::Vector3d> corners;
  corners.reserve(6 * (across - 1) * (along - 1));
  for (std::size_t k = 0; k + 1 < along; ++k)
    for (std::size_t i = 0; i + 1 < across; ++i)
      for (const auto& [right, up] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
        corners.push_back(corner(i + static_cast<std::size_t>(right), k + static_cast<std::size_t>(up)));
  return corners;
}

void put_empty_end(CdrWriter& out) {
  out.put_count(0);  // colors
  out.put(std::string_view());
  put_header(out, 0, "");  // texture
  out.put(std::string_view());
  out.put_count(0);
  out.put_count(0);  // uv_coordinates
  out.put(std::string_view());
  out.put(std::string_view());
  out.put(std::string_view());  // mesh_file
  out.put_count(0);
  out.put(std::uint8_t{0});
}

void put_vector(CdrWriter& out, const sim::Vector3d& v) {
  out.put_array(std::span<const double>(v.data(), 3));
}

void put(CdrWriter& out, std::int64_t utime, const Marker& marker, std::int32_t action) {
  // Name and place
  put_header(out, utime, marker.frame);
  out.put(std::string_view(marker.name));
  out.put(marker.id);
  out.put(static_cast<std::int32_t>(marker.type));
  out.put(action);
  put_vector(out, marker.pose.translation());
  const sim::Quaterniond q(marker.pose.linear());
  put_numbers(out, {q.x(), q.y(), q.z(), q.w()});

  // Look, without an end, and fixed in its frame
  put_vector(out, marker.scale);
  out.put_array(std::span<const float>(marker.rgba));
  out.put(std::int32_t{0});
  out.put(std::uint32_t{0});
  out.put(std::uint8_t{1});
  out.put_count(marker.points_m.size());
  for (const sim::Vector3d& point : marker.points_m) put_vector(out, point);
  put_empty_end(out);
}

}  // namespace

std::vector<sim::Vector3d> triangles_of_asset(std::span<const std::uint8_t> asset) {
  AssetReader in(asset);
  const auto kind = in.number<std::uint32_t>();
  if (kind == mesh_asset) return triangles_of_mesh(in);
  if (kind == grid_asset) return triangles_of_grid(in);
  return {};
}

void put_marker(CdrWriter& out, std::int64_t utime, const Marker& marker) {
  constexpr std::int32_t add = 0;
  put(out, utime, marker, add);
}

void put_removal_of_all(CdrWriter& out, std::int64_t utime) {
  constexpr std::int32_t delete_all = 3;
  Marker marker;
  marker.frame = world_frame;
  put(out, utime, marker, delete_all);
}

}  // namespace bridges::ros2
