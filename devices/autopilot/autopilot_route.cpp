// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/autopilot_route.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "sim/base/math.hpp"

namespace devices {

namespace {

void read_point(sim::ParamReader& in, const char* key, Eigen::Vector2d& value, const char* meaning) {
  std::vector<double> numbers{value.x(), value.y()};
  in.require(key);
  in.read(key, numbers, sim::any_place(), meaning);
  if (in.describing()) return;
  if (numbers.size() != 2) return in.error(key, "'" + std::string(key) + "' must be two numbers, east and north");
  value = {numbers[0], numbers[1]};
}

void check_one_height(sim::ParamReader& in, const std::optional<double>& depth_m,
                      const std::optional<double>& altitude_m) {
  if (!in.describing() && depth_m && altitude_m) in.error("altitude_m", "give 'depth_m' or 'altitude_m', not both");
}

}  // namespace

void Waypoint::read(sim::ParamReader& in) {
  read_point(in, "at_m", p_W, "[east, north] in the world frame");
  in.read("depth_m", depth_m, sim::any_place(), "below the still surface; unset: as before");
  in.read("altitude_m", altitude_m, sim::above(0), "over the bottom, in place of a depth");
  in.read("speed_mps", speed_mps, sim::between(0, 100), "through the water; unset: as before");
  check_one_height(in, depth_m, altitude_m);
}

void Lawnmower::read(sim::ParamReader& in) {
  read_point(in, "corner_m", corner_m, "[east, north] where the first track begins");
  in.read_deg("direction_deg", direction_rad, sim::between(-360, 360),
              "direction of the first track, counter-clockwise from east");
  in.read("length_m", length_m, sim::above_to(0, 1e6), "length of a track");
  in.read("width_m", width_m, sim::between(-1e6, 1e6), "to the left of the first track; negative: to its right");
  in.read("spacing_m", spacing_m, sim::above_to(0, 1e6), "between tracks");
  in.read("depth_m", depth_m, sim::any_place(), "below the still surface; unset: as before");
  in.read("altitude_m", altitude_m, sim::above(0), "over the bottom, in place of a depth");
  in.read("speed_mps", speed_mps, sim::between(0, 100), "through the water; unset: as before");
  check_one_height(in, depth_m, altitude_m);
  if (!in.describing() && std::abs(width_m) / spacing_m > 10000)
    in.error("spacing_m", "'spacing_m' makes over 10000 tracks");
}

std::vector<Waypoint> Lawnmower::waypoints() const {
  const Eigen::Vector2d along(std::cos(direction_rad), std::sin(direction_rad));
  const Eigen::Vector2d left(-along.y(), along.x());
  // Tolerance so that rounding does not drop a last track on the edge.
  const int tracks = static_cast<int>(std::floor(std::abs(width_m) / spacing_m + 1e-9)) + 1;
  std::vector<Waypoint> points;
  for (int track = 0; track < tracks; ++track) {
    const Eigen::Vector2d near = corner_m + left * std::copysign(track * spacing_m, width_m);
    const Eigen::Vector2d far = near + along * length_m;
    for (const Eigen::Vector2d& end : {track % 2 == 0 ? near : far, track % 2 == 0 ? far : near})
      points.push_back({end, depth_m, altitude_m, speed_mps});
  }
  return points;
}

void GuidanceParams::read(sim::ParamReader& in) {
  in.read("lookahead_m", lookahead_m, sim::above(0), "look-ahead distance on the leg; a few lengths of the craft");
  in.read("integral", integral, sim::between(0, 10),
          "against drift: gain of the integral of the cross-track error, m/s; typically a quarter of the speed");
  in.read("acceptance_radius_m", acceptance_radius_m, sim::above(0),
          "distance within which a waypoint counts as reached");
}

void Route::start(std::vector<Waypoint> points, bool loop, const Eigen::Vector2d& from_W) {
  points_ = std::move(points);
  loop_ = loop;
  finished_ = false;
  to_ = 0;
  from_W_ = from_W;
  bias_m_ = 0;
}

bool Route::reached(const Eigen::Vector2d& p_W) const {
  const Eigen::Vector2d leg = to().p_W - from_W_;
  return (to().p_W - p_W).norm() <= params_.acceptance_radius_m || (p_W - to().p_W).dot(leg) > 0;
}

Aim Route::aim(const Eigen::Vector2d& p_W, const Eigen::Vector2d& v_W, double heading_rad, double dt_s) {
  // Switch past all waypoints reached, each at most once.
  for (std::size_t looked = 0; !finished_ && looked < points_.size() && reached(p_W); ++looked) {
    if (to_ + 1 == points_.size() && !loop_) {
      finished_ = true;
      break;
    }
    from_W_ = to().p_W;
    to_ = (to_ + 1) % points_.size();
    bias_m_ = 0;
  }
  const Eigen::Vector2d leg = to().p_W - from_W_, offset = p_W - from_W_;
  Aim aim;
  aim.distance_m = (to().p_W - p_W).norm();
  // Head for the waypoint itself when the leg has no length.
  const double length = leg.norm();
  if (length < 1e-6) {
    aim.heading_rad = std::atan2(to().p_W.y() - p_W.y(), to().p_W.x() - p_W.x());
    return aim;
  }
  // Line-of-sight heading with integral action.
  aim.cross_track_m = (leg.x() * offset.y() - leg.y() * offset.x()) / length;
  const double lookahead = params_.lookahead_m, biased = aim.cross_track_m + bias_m_;
  aim.heading_rad = sim::wrap_angle(std::atan2(leg.y(), leg.x()) - std::atan(biased / lookahead));
  // Integrate where the heading follows (anti-windup in turns), up to a drift of 97 % of the speed.
  constexpr double turning_rad = 0.3, slow_mps = 0.1, max_lookaheads = 4;
  if (std::abs(sim::wrap_angle(aim.heading_rad - heading_rad)) > turning_rad) return aim;
  const auto sine = [lookahead](double y) { return y / std::hypot(lookahead, y); };
  const double speed = v_W.norm(), across_mps = (leg.x() * v_W.y() - leg.y() * v_W.x()) / length;
  const double missed = (across_mps + speed * (sine(biased) - sine(bias_m_))) / std::max(speed, slow_mps);
  bias_m_ =
      std::clamp(bias_m_ + params_.integral * missed * dt_s, -max_lookaheads * lookahead, max_lookaheads * lookahead);
  return aim;
}

void Circle::start(const Eigen::Vector2d& center_W, const Eigen::Vector2d& p_W, double heading_rad) {
  center_W_ = center_W;
  const Eigen::Vector2d out = p_W - center_W;
  turn_ = out.x() * std::sin(heading_rad) - out.y() * std::cos(heading_rad) < 0 ? -1 : 1;
}

Aim Circle::aim(const Eigen::Vector2d& p_W) const {
  constexpr double gain = 2;
  const Eigen::Vector2d out = p_W - center_W_;
  Aim aim;
  aim.distance_m = out.norm();
  const double beyond_m = aim.distance_m - radius_m_;
  aim.cross_track_m = -turn_ * beyond_m;
  aim.heading_rad = sim::wrap_angle(std::atan2(out.y(), out.x()) +
                                    turn_ * (std::numbers::pi / 2 + std::atan(gain * beyond_m / radius_m_)));
  return aim;
}

void Circle::visit_state(sim::StateArchive& archive) {
  archive(center_W_, turn_);
  if (archive.restoring() && turn_ != 1 && turn_ != -1) archive.fail("direction of the circle: left or right");
}

void Route::visit_state(sim::StateArchive& archive) {
  archive(points_, loop_, finished_, to_, from_W_, bias_m_);
  if (to_ >= std::max<std::size_t>(points_.size(), 1))
    archive.fail("a route of " + std::to_string(points_.size()) + " waypoints has no number " + std::to_string(to_));
}

}  // namespace devices
