// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converters/surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bridges/ros2/converters/common_parts.hpp"
#include "bridges/ros2/converters/point_cloud.hpp"
#include "shoal/sim_bodies_t.hpp"

namespace bridges::ros2 {
namespace {

using sim::Vector3d;

/// Two numbers from 0 to 1, by which points are even on a surface: Roberts, The unreasonable effectiveness of
/// quasirandom sequences (2018), from the root of x^3 = x + 1.
std::array<double, 2> even_pair(std::size_t i) {
  constexpr double root = 1.32471795724474602596;
  const auto n = static_cast<double>(i);
  return {std::fmod(0.5 + n / root, 1.0), std::fmod(0.5 + n / (root * root), 1.0)};
}

Vector3d on_circle(double turns, double radius_m, double z_m) {
  const double angle_rad = 2 * std::numbers::pi * turns;
  return {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z_m};
}

/// Areas of the pieces of the surface: the sides of a box, the mantle and ends of a cylinder, triangles.
std::vector<double> piece_areas_m2(const Marker& marker) {
  const Vector3d& size = marker.scale;
  const double radius_m = size.x() / 2;
  switch (marker.type) {
    case MarkerType::cube: {
      std::vector<double> areas;
      for (int axis = 0; axis < 3; ++axis) areas.insert(areas.end(), 2, size[(axis + 1) % 3] * size[(axis + 2) % 3]);
      return areas;
    }
    case MarkerType::sphere:
      return {4 * std::numbers::pi * radius_m * radius_m};
    case MarkerType::cylinder:
      return {2 * std::numbers::pi * radius_m * size.z(), std::numbers::pi * radius_m * radius_m,
              std::numbers::pi * radius_m * radius_m};
    case MarkerType::triangle_list: {
      std::vector<double> areas;
      const auto& p = marker.points_m;
      for (std::size_t i = 0; i + 2 < p.size(); i += 3)
        areas.push_back((p[i + 1] - p[i]).cross(p[i + 2] - p[i]).norm() / 2);
      return areas;
    }
    case MarkerType::line_strip:
      break;
  }
  return {};
}

/// A point of a piece, by two numbers from 0 to 1.
Vector3d point_of_piece(const Marker& marker, std::size_t piece, double u, double v) {
  const Vector3d& size = marker.scale;
  const double radius_m = size.x() / 2;
  switch (marker.type) {
    case MarkerType::cube: {
      const auto axis = static_cast<int>(piece / 2);
      Vector3d point;
      point[axis] = size[axis] * (piece % 2 == 0 ? 0.5 : -0.5);
      point[(axis + 1) % 3] = size[(axis + 1) % 3] * (u - 0.5);
      point[(axis + 2) % 3] = size[(axis + 2) % 3] * (v - 0.5);
      return point;
    }
    case MarkerType::sphere: {
      const double z = 2 * v - 1;
      return on_circle(u, radius_m * std::sqrt(1 - z * z), radius_m * z);
    }
    case MarkerType::cylinder:
      if (piece == 0) return on_circle(u, radius_m, size.z() * (v - 0.5));
      return on_circle(u, radius_m * std::sqrt(v), size.z() * (piece == 1 ? 0.5 : -0.5));
    case MarkerType::triangle_list: {
      const Vector3d* const corner = marker.points_m.data() + 3 * piece;
      const double root = std::sqrt(u);
      return (1 - root) * corner[0] + root * ((1 - v) * corner[1] + v * corner[2]);
    }
    case MarkerType::line_strip:
      break;
  }
  return Vector3d::Zero();
}

std::uint32_t packed(const std::array<float, 4>& rgba) {
  std::uint32_t rgb = 0;
  for (std::size_t i = 0; i < 3; ++i)
    rgb = rgb << 8 | static_cast<std::uint32_t>(std::lround(255 * std::clamp(rgba[i], 0.0F, 1.0F)));
  return rgb;
}

// --- Converters

constexpr std::array columns{PointColumn{"x", 0, point_float32}, PointColumn{"y", 4, point_float32},
                             PointColumn{"z", 8, point_float32}, PointColumn{"rgb", 12, point_float32}};
constexpr std::uint32_t point_bytes = 16;

/// Shortest time between two clouds of the bodies that move: each has all points.
constexpr std::uint64_t period_us = 1'000'000;

/// To 1/256 m: the zeros behind make a compressed file smaller.
float rounded(float value_m) {
  return std::nearbyint(256 * value_m) / 256;
}

/// Appends a cloud in the world.
void put_points(CdrWriter& out, std::int64_t utime, std::span<const SurfacePoint> points) {
  put_header(out, utime, world_frame);
  std::byte* place = put_cloud(out, columns, point_bytes, points.size());
  for (const SurfacePoint& point : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) store(place, 4 * axis, rounded(point.position_m[axis]));
    store(place, 12, point.rgb);
    place += point_bytes;
  }
  out.put(true);  // every point is valid
}

bool write_moving_surfaces(const shoal::sim_bodies_t& message, ConverterContext& context, CdrWriter& out) {
  // Of earlier times, after a rewind, the difference is huge.
  const auto since_us =
      static_cast<std::uint64_t>(message.utime) - static_cast<std::uint64_t>(context.moving_surfaces_utime.value_or(0));
  if (message.revision != context.scene_revision) return false;
  if (context.moving_surfaces_utime && since_us < period_us) return false;
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < static_cast<std::size_t>(message.count); ++i) {
    const auto body = context.surfaces().moving.find(message.body[i]);
    if (body == context.surfaces().moving.end()) continue;
    const sim::Quaterniond q(message.orientation[i][0], message.orientation[i][1], message.orientation[i][2],
                             message.orientation[i][3]);
    const Eigen::Matrix3f turn = q.toRotationMatrix().cast<float>();
    const Vector3d place_m(message.position_m[i].data());
    for (SurfacePoint point : body->second) {
      const Eigen::Vector3f turned = turn * Eigen::Vector3f(point.position_m.data());
      for (int axis = 0; axis < 3; ++axis)
        point.position_m[static_cast<std::size_t>(axis)] = static_cast<float>(place_m[axis]) + turned[axis];
      points.push_back(point);
    }
  }
  if (points.empty()) return false;
  context.moving_surfaces_utime = message.utime;
  put_points(out, message.utime, points);
  return true;
}

/// Once for each scene, and again when it has further assets.
bool write_fixed_surfaces(const shoal::sim_bodies_t& message, ConverterContext& context, CdrWriter& out) {
  const ConverterContext::Surfaces& surfaces = context.surfaces();
  if (surfaces.fixed.empty() || context.fixed_surfaces_are_sent) return false;
  context.fixed_surfaces_are_sent = true;
  put_points(out, message.utime, surfaces.fixed);
  return true;
}

SHOAL_ROS2_CONVERTER(write_moving_surfaces, "sensor_msgs/msg/PointCloud2", "/surfaces");
SHOAL_ROS2_CONVERTER(write_fixed_surfaces, "sensor_msgs/msg/PointCloud2", "/surfaces_fixed");

}  // namespace

double surface_area_m2(const Marker& marker) {
  const std::vector<double> areas_m2 = piece_areas_m2(marker);
  return std::accumulate(areas_m2.begin(), areas_m2.end(), 0.0);
}

void add_surface_points(const Marker& marker, std::size_t count, std::vector<SurfacePoint>& points) {
  std::vector<double> up_to_m2 = piece_areas_m2(marker);
  std::partial_sum(up_to_m2.begin(), up_to_m2.end(), up_to_m2.begin());
  if (up_to_m2.empty() || !(up_to_m2.back() > 0)) return;
  const std::uint32_t rgb = packed(marker.rgba);
  for (std::size_t i = 0; i < count; ++i) {
    const double at_m2 = up_to_m2.back() * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const auto piece = std::upper_bound(up_to_m2.begin(), up_to_m2.end() - 1, at_m2) - up_to_m2.begin();
    const auto [u, v] = even_pair(i);
    const Eigen::Vector3f point =
        (marker.pose * point_of_piece(marker, static_cast<std::size_t>(piece), u, v)).cast<float>();
    points.push_back({{point.x(), point.y(), point.z()}, rgb});
  }
}

}  // namespace bridges::ros2
