// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/path.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "shoal/message_codec.hpp"

namespace autonomy {

shoal::waypoints_command_t path_message(std::int64_t utime, const std::vector<Vector2d>& path_W) {
  shoal::waypoints_command_t message{};
  message.utime = utime;
  message.n = static_cast<std::int32_t>(path_W.size());
  for (const Vector2d& p_W : path_W) {
    message.x_m.push_back(p_W.x());
    message.y_m.push_back(p_W.y());
    message.depth_m.push_back(unknown);
  }
  message.speed_mps = unknown;
  return message;
}

std::vector<Vector2d> path_of(const shoal::waypoints_command_t& message) {
  constexpr double farthest_m = 1e7;
  std::vector<Vector2d> path_W;
  for (std::size_t i = 0; i < message.x_m.size(); ++i) {
    path_W.emplace_back(message.x_m[i], message.y_m[i]);
    if (!(std::abs(message.x_m[i]) <= farthest_m && std::abs(message.y_m[i]) <= farthest_m))
      throw shoal::MessageError(fmt::format("point {} must be within {:g} m, got ({:g}, {:g})", i + 1, farthest_m,
                                            message.x_m[i], message.y_m[i]));
  }
  return path_W;
}

OnPath nearest_on(const std::vector<Vector2d>& path_W, const Vector2d& p_W) {
  OnPath nearest{0, path_W.front()};
  double nearest_m = (path_W.front() - p_W).norm();
  for (std::size_t i = 0; i + 1 < path_W.size(); ++i) {
    const Vector2d along = path_W[i + 1] - path_W[i];
    // Two equal points in a row have no direction.
    const double share = std::clamp(along.dot(p_W - path_W[i]) / std::max(1e-12, along.squaredNorm()), 0.0, 1.0);
    const Vector2d at_W = path_W[i] + share * along;
    if (const double distance_m = (at_W - p_W).norm(); distance_m < nearest_m) {
      nearest_m = distance_m;
      nearest = {i, at_W};
    }
  }
  return nearest;
}

Vector2d ahead_on(const std::vector<Vector2d>& path_W, OnPath from, double ahead_m) {
  for (; from.before + 1 < path_W.size(); ++from.before) {
    const Vector2d rest = path_W[from.before + 1] - from.p_W;
    const double length_m = rest.norm();
    if (length_m >= ahead_m && length_m > 0) return from.p_W + ahead_m / length_m * rest;
    ahead_m -= length_m;
    from.p_W = path_W[from.before + 1];
  }
  return from.p_W;
}

}  // namespace autonomy
