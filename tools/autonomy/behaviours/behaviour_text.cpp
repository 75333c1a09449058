// SPDX-License-Identifier: BSD-3-Clause
#include "tools/autonomy/behaviours/behaviour_text.hpp"

#include <stdexcept>

#include "tools/autonomy/behaviours/waypoint_text.hpp"

namespace autonomy {

namespace {

std::unique_ptr<HelmBehaviour> make_route(std::vector<Vector2d> waypoints_W, double speed_mps, bool loop) {
  RouteBehaviour::Params params;
  params.speed_mps = speed_mps;
  params.loop = loop;
  return std::make_unique<RouteBehaviour>(std::move(waypoints_W), params);
}

std::unique_ptr<HelmBehaviour> make_circle(const std::string& text, double speed_mps) {
  const std::vector<double> numbers = parse_numbers(text, 3, "circle:X,Y,RADIUS");
  if (numbers[2] <= 0) throw std::invalid_argument("the radius of a circle must be > 0");
  CircleBehaviour::Params params;
  params.centre_W = {numbers[0], numbers[1]};
  params.radius_m = numbers[2];
  params.speed_mps = speed_mps;
  return std::make_unique<CircleBehaviour>(params);
}

std::unique_ptr<HelmBehaviour> make_zigzag(const std::string& text, double speed_mps, bool loop) {
  const std::vector<double> numbers = parse_numbers(text, 6, "zigzag:X1,Y1,X2,Y2,AMPLITUDE,LEGS");
  if (!(numbers[5] >= 1 && numbers[5] <= 1000)) throw std::invalid_argument("a zigzag has 1 to 1000 legs");
  return make_route(
      zigzag({numbers[0], numbers[1]}, {numbers[2], numbers[3]}, numbers[4], static_cast<int>(numbers[5])), speed_mps,
      loop);
}

std::unique_ptr<HelmBehaviour> make_follow(const std::string& text, double speed_mps) {
  const std::size_t comma = text.find(',');
  if (comma == 0 || comma == std::string::npos)
    throw std::invalid_argument("'" + text + "' is not of the form follow:VEHICLE,AHEAD,LEFT");
  const std::vector<double> numbers = parse_numbers(text.substr(comma + 1), 2, "follow:VEHICLE,AHEAD,LEFT");
  FollowBehaviour::Params params;
  params.vehicle = text.substr(0, comma);
  params.ahead_m = numbers[0];
  params.left_m = numbers[1];
  params.speed_max_mps = speed_mps;
  return std::make_unique<FollowBehaviour>(params);
}

}  // namespace

std::unique_ptr<HelmBehaviour> make_behaviour(const std::string& text, const std::vector<Vector2d>& route_W,
                                              double speed_mps, bool loop) {
  const std::size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (kind == "route" && rest.empty()) {
    if (route_W.empty()) throw std::invalid_argument("the behaviour 'route' needs --route");
    return make_route(route_W, speed_mps, loop);
  }
  if (kind == "circle") return make_circle(rest, speed_mps);
  if (kind == "zigzag") return make_zigzag(rest, speed_mps, loop);
  if (kind == "follow") return make_follow(rest, speed_mps);
  throw std::invalid_argument("unknown behaviour '" + text + "'; known: route, circle:..., zigzag:..., follow:...");
}

}  // namespace autonomy
