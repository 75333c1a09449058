// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/estimates/vehicle_path.hpp"

#include <algorithm>
#include <cmath>

#include "shoal/message_codec.hpp"
#include "shoal/waypoints_command_t.hpp"

namespace viewer {

namespace {

constexpr double farthest_m = 1e7;

/// Returns the number of the i-th of the `kept` evenly spaced items of `size`, the first and the last included.
std::size_t spaced(std::size_t i, std::size_t kept, std::size_t size) {
  return kept < 2 ? 0 : i * (size - 1) / (kept - 1);
}

}  // namespace

bool VehiclePath::Point::operator==(const Point& other) const {
  const bool same_depth = depth_m == other.depth_m || (std::isnan(depth_m) && std::isnan(other.depth_m));
  return x_m == other.x_m && y_m == other.y_m && same_depth;
}

std::optional<VehiclePath> read_path(std::span<const std::byte> payload) {
  constexpr std::size_t fingerprint_bytes = 8;
  if (payload.size() < fingerprint_bytes ||
      shoal::fingerprint(payload) != shoal::fingerprint_of<shoal::waypoints_command_t>())
    return std::nullopt;
  const auto message = shoal::decode<shoal::waypoints_command_t>(payload, shoal::Finite::any);
  VehiclePath path{message.utime, {}, message.loop != 0};
  const std::size_t size = message.x_m.size(), kept = std::min(size, VehiclePath::max_points);
  path.points.reserve(kept);
  // Long paths are thinned evenly: a page cannot show more points than it has pixels.
  for (std::size_t i = 0; i < kept; ++i) {
    const std::size_t at = spaced(i, kept, size);
    const VehiclePath::Point point{message.x_m[at], message.y_m[at], message.depth_m[at]};
    // A wild value would stretch the view until nothing else can be seen; NaN depths mean 'as before' and pass.
    const bool is_near = std::abs(point.x_m) <= farthest_m && std::abs(point.y_m) <= farthest_m;
    if (!is_near || std::abs(point.depth_m) > farthest_m) return std::nullopt;
    path.points.push_back(point);
  }
  return path;
}

std::string path_vehicle(std::string_view channel) {
  return std::string(channel.substr(0, channel.find('.')));
}

}  // namespace viewer
