// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/math.hpp"

namespace viewer {

/// Where a vehicle means to go, by a message of one of its programs.
struct VehiclePath {
  /// Point of a path.
  struct Point {
    double x_m = 0, y_m = 0;
    double depth_m = 0;  ///< below the still surface; NaN: not given
    bool operator==(const Point& other) const;
  };
  /// Maximum number of points: of a longer path evenly spaced ones are kept.
  static constexpr std::size_t max_points = 1000;

  std::int64_t utime = 0;  ///< by the clock of the vehicle
  std::vector<Point> points;
  bool loop = false;  ///< from the last point to the first

  /// Returns whether the other one leads along the same points.
  bool leads_along(const VehiclePath& other) const { return points == other.points && loop == other.loop; }
};

/// Reads shoal.waypoints_command_t: the path of a planner, or the route of an autopilot.  Returns std::nullopt for
/// other messages, and for points that are not finite or farther away than 1e7 m.  Throws shoal::MessageError when the
/// message is damaged.
std::optional<VehiclePath> read_path(std::span<const std::byte> payload);

/// Returns the vehicle of a channel such as `VEHICLE.path`: its part before the first dot.
std::string path_vehicle(std::string_view channel);

}  // namespace viewer
