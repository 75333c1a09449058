// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <string_view>

#include "bridges/ros2/cdr.hpp"

namespace bridges::ros2 {

/// Column of sensor_msgs/PointCloud2.
struct PointColumn {
  std::string_view name;
  std::uint32_t offset;   ///< in a point
  std::uint8_t datatype;  ///< as in sensor_msgs/PointField
};

inline constexpr std::uint8_t point_uint16 = 4, point_int32 = 5, point_float32 = 7;

/// Appends what follows the header of a point cloud without rows, and returns space for the points.
inline std::byte* put_cloud(CdrWriter& out, std::span<const PointColumn> columns, std::uint32_t point_bytes,
                            std::size_t points) {
  out.put(std::uint32_t{1});
  out.put(static_cast<std::uint32_t>(points));
  out.put_count(columns.size());
  for (const PointColumn& column : columns) {
    out.put(column.name);
    out.put(column.offset);
    out.put(column.datatype);
    out.put(std::uint32_t{1});
  }
  out.put(false);  // little-endian
  out.put(point_bytes);
  out.put(static_cast<std::uint32_t>(points * point_bytes));
  out.put_count(points * point_bytes);
  return out.room(points * point_bytes, 1);
}

/// Stores a number in a point.
template <class T>
void store(std::byte* point, std::size_t offset, T value) {
  std::memcpy(point + offset, &value, sizeof value);
}

}  // namespace bridges::ros2
