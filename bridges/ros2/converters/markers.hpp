// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bridges/ros2/cdr.hpp"
#include "sim/base/math.hpp"

namespace bridges::ros2 {

/// Shape of visualization_msgs/Marker.
enum class MarkerType : std::int32_t { cube = 1, sphere = 2, cylinder = 3, line_strip = 4, triangle_list = 11 };

/// Marker that follows its frame until it is replaced.
struct Marker {
  std::string frame;    ///< coordinate frame
  std::string name;     ///< namespace; with `id` the key of the marker
  std::int32_t id = 0;  ///< number in the namespace
  MarkerType type = MarkerType::cube;
  sim::Pose pose = sim::Pose::Identity();  ///< in the frame
  sim::Vector3d scale{1, 1, 1};            ///< extent along the axes of the marker, m
  std::array<float, 4> rgba{};             ///< color, 0 to 1
  std::vector<sim::Vector3d> points_m;     ///< of lines and triangles
};

/// Maximum number of triangles of a mesh; larger ones have no marker.
inline constexpr std::size_t max_marker_triangles = 100'000;
/// Maximum number of rows and columns of a terrain; larger ones are thinned out.
inline constexpr std::size_t max_marker_grid = 160;

/// Returns the corners of the triangles of an asset (docs/develop/view_protocol.md); none of an image, of other
/// bytes, and of a mesh with too many triangles.
std::vector<sim::Vector3d> triangles_of_asset(std::span<const std::uint8_t> asset);
/// Appends visualization_msgs/Marker.
void put_marker(CdrWriter& out, std::int64_t utime, const Marker& marker);
/// Appends the marker that removes all earlier ones.
void put_removal_of_all(CdrWriter& out, std::int64_t utime);

}  // namespace bridges::ros2
