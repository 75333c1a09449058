// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// A point of a route in the world's horizontal plane.  Unset members are unchanged.
struct Waypoint {
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
  std::optional<double> depth_m;     ///< below the still surface
  std::optional<double> altitude_m;  ///< over the bottom
  std::optional<double> speed_mps;   ///< through the water
  void read(sim::ParamReader& in);
  void visit_state(sim::StateArchive& archive) { archive(p_W, depth_m, altitude_m, speed_mps); }
};

/// Parallel tracks over a rectangle.
struct Lawnmower {
  Eigen::Vector2d corner_m = Eigen::Vector2d::Zero();  ///< where the first track begins
  double direction_rad = 0;                            ///< of the first track, counter-clockwise from east
  double length_m = 100;                               ///< of a track
  double width_m = 50;                                 ///< to the left of the first track; negative: to its right
  double spacing_m = 10;
  std::optional<double> depth_m, altitude_m, speed_mps;
  void read(sim::ParamReader& in);
  /// Both ends of each track, in the order in which they are run.
  std::vector<Waypoint> waypoints() const;
};

/// How a craft follows its route.
struct GuidanceParams {
  double lookahead_m = 10;
  double integral = 0.5;  ///< m/s; 0: none
  double acceptance_radius_m = 3;
  void read(sim::ParamReader& in);
};

/// Where to head now.
struct Aim {
  double heading_rad = 0;
  double cross_track_m = 0;  ///< left of the leg is positive
  double distance_m = 0;     ///< to the waypoint
};

/// Follows the legs of a route by line of sight with an integral against drift (ILOS: Borhaug, Pavlov, Pettersen 2008;
/// Fossen 2021, section 12.4):
///   heading = direction of the leg - atan((e + kappa s) / Delta),  s' = Delta e / (Delta^2 + (e + kappa s)^2),
/// with e the cross-track error, Delta the lookahead, kappa the integral; s stands while |e| > Delta / 2.  A waypoint
/// is reached inside of its radius, or when the craft has passed the line through it across the leg: the craft does
/// not return to a missed point.
class Route {
 public:
  explicit Route(const GuidanceParams& params) : params_(params) {}

  /// Begins at `from_W`.
  void start(std::vector<Waypoint> points, bool loop, const Eigen::Vector2d& from_W);
  /// Continues to the next waypoint where one was reached.  Not for an empty route.
  Aim aim(const Eigen::Vector2d& p_W, double dt_s);
  /// The one it goes to.
  const Waypoint& to() const { return points_[to_]; }
  std::size_t index() const { return to_; }
  std::size_t size() const { return points_.size(); }
  const std::vector<Waypoint>& points() const { return points_; }
  bool loops() const { return loop_; }
  bool finished() const { return finished_; }
  void visit_state(sim::StateArchive& archive);

 private:
  bool reached(const Eigen::Vector2d& p_W) const;

  GuidanceParams params_;
  std::vector<Waypoint> points_;
  bool loop_ = false;
  bool finished_ = false;
  std::size_t to_ = 0;
  Eigen::Vector2d from_W_ = Eigen::Vector2d::Zero();
  double sum_m_ = 0;
};

/// Circles around a place by a vector field (Nelson, Barber, McLain, Beard, Vector field path following for miniature
/// air vehicles, 2007, eq. 11), here with angles counter-clockwise from east and a gain of 2:
///   course = phi + turn (pi/2 + atan(2 (d - R) / R)),
/// with phi the direction from the place to the craft, d their distance, R the radius, turn 1 counter-clockwise or -1.
class Circle {
 public:
  explicit Circle(double radius_m) : radius_m_(radius_m) {}

  /// From `p_W` with this heading; the side is the one to which the craft turns less.
  void start(const Eigen::Vector2d& center_W, const Eigen::Vector2d& p_W, double heading_rad);
  /// `heading_rad` of the aim is the course over ground that leads to the circle and along it; `distance_m` is to its
  /// center.
  Aim aim(const Eigen::Vector2d& p_W) const;
  void visit_state(sim::StateArchive& archive);

 private:
  double radius_m_;
  Eigen::Vector2d center_W_ = Eigen::Vector2d::Zero();
  int turn_ = 1;
};

}  // namespace devices
