// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/make_behavior.hpp"

#include <stdexcept>

namespace autonomy {

std::unique_ptr<HelmBehavior> make_route(std::vector<Vector2d> waypoints_W, double speed_mps, bool loop) {
  RouteBehavior::Params params;
  params.speed_mps = speed_mps;
  params.loop = loop;
  return std::make_unique<RouteBehavior>(std::move(waypoints_W), params);
}

std::unique_ptr<HelmBehavior> make_circle(const Vector2d& center_W, double radius_m, double speed_mps) {
  if (!(radius_m > 0)) throw std::invalid_argument("the radius of a circle must be > 0");
  CircleBehavior::Params params;
  params.center_W = center_W;
  params.radius_m = radius_m;
  params.speed_mps = speed_mps;
  return std::make_unique<CircleBehavior>(params);
}

std::unique_ptr<HelmBehavior> make_zigzag(const Vector2d& from_W, const Vector2d& to_W, double amplitude_m, int legs,
                                          double speed_mps, bool loop) {
  if (!(legs >= 1 && legs <= 1000)) throw std::invalid_argument("a zigzag has 1 to 1000 legs");
  return make_route(zigzag(from_W, to_W, amplitude_m, legs), speed_mps, loop);
}

std::unique_ptr<HelmBehavior> make_follow(const std::string& vehicle, double ahead_m, double left_m,
                                          double speed_max_mps) {
  FollowBehavior::Params params;
  params.vehicle = vehicle;
  params.ahead_m = ahead_m;
  params.left_m = left_m;
  params.speed_max_mps = speed_max_mps;
  return std::make_unique<FollowBehavior>(params);
}

}  // namespace autonomy
