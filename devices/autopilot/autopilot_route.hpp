// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// Waypoint in the horizontal plane of the world.  Unset members keep the previous setpoints.
struct Waypoint {
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
  std::optional<double> depth_m;     ///< below the still surface
  std::optional<double> altitude_m;  ///< over the bottom
  std::optional<double> speed_mps;   ///< through the water
  void read(sim::ParamReader& in);
  void visit_state(sim::StateArchive& archive) { archive(p_W, depth_m, altitude_m, speed_mps); }
};

/// Lawnmower pattern: parallel tracks over a rectangle.
struct Lawnmower {
  Eigen::Vector2d corner_m = Eigen::Vector2d::Zero();  ///< start of the first track
  double direction_rad = 0;                            ///< direction of the first track, counter-clockwise from east
  double length_m = 100;                               ///< length of a track
  double width_m = 50;                                 ///< width to the left of the first track; negative: to its right
  double spacing_m = 10;
  std::optional<double> depth_m, altitude_m, speed_mps;
  void read(sim::ParamReader& in);
  /// Returns both ends of each track, in the order of travel.
  std::vector<Waypoint> waypoints() const;
};

/// Parameters of path following.
struct GuidanceParams {
  double lookahead_m = 10;
  double integral = 0.5;  ///< m/s; 0: none
  double acceptance_radius_m = 3;
  void read(sim::ParamReader& in);
};

/// Output of the guidance law.
struct Aim {
  double heading_rad = 0;
  double cross_track_m = 0;  ///< positive to the left of the leg
  double distance_m = 0;     ///< distance to the waypoint
};

/// Follows the legs of a route by integral line-of-sight guidance, which compensates drift (after ILOS: Borhaug,
/// Pavlov, Pettersen 2008; Fossen 2021, section 12.4):
///   heading = direction of the leg - atan((e + b) / Delta),  b' = kappa (e' / U + f(e + b) - f(b)),
/// with e the cross-track error, Delta the lookahead distance, U the speed over ground, kappa the integral gain, and
/// f(y) = y / sqrt(Delta^2 + y^2).  Near the leg b' is kappa / Delta (e + Delta e' / U): the integral of the error,
/// less the way that the guidance itself makes towards the leg, so that it does not wind up there.  b is held while the
/// craft turns to its heading.  A waypoint is reached within its acceptance radius, or when the craft passes the line
/// through it perpendicular to the leg, so that the craft does not return to a missed waypoint.
class Route {
 public:
  explicit Route(const GuidanceParams& params) : params_(params) {}

  /// Starts a route at `from_W`.
  void start(std::vector<Waypoint> points, bool loop, const Eigen::Vector2d& from_W);
  /// Switches to the next waypoint when one is reached and returns the guidance.  `v_W`: velocity over ground;
  /// `heading_rad`: of the craft.  The route must not be empty.
  Aim aim(const Eigen::Vector2d& p_W, const Eigen::Vector2d& v_W, double heading_rad, double dt_s);
  /// Returns the current waypoint.
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
  double bias_m_ = 0;  // b
};

/// Circles around a point by a vector field (Nelson, Barber, McLain, Beard, Vector field path following for miniature
/// air vehicles, 2007, eq. 11), here with angles counter-clockwise from east and a gain of 2:
///   course = phi + turn (pi/2 + atan(2 (d - R) / R)),
/// with phi the direction from the point to the craft, d their distance, R the radius, turn 1 counter-clockwise or -1.
class Circle {
 public:
  explicit Circle(double radius_m) : radius_m_(radius_m) {}

  /// Starts at `p_W` with the given heading.  The direction of rotation is the one that needs the smaller turn.
  void start(const Eigen::Vector2d& center_W, const Eigen::Vector2d& p_W, double heading_rad);
  /// Returns the guidance.  `heading_rad` is the course over ground to and along the circle; `distance_m` is the
  /// distance to its center.
  Aim aim(const Eigen::Vector2d& p_W) const;
  void visit_state(sim::StateArchive& archive);

 private:
  double radius_m_;
  Eigen::Vector2d center_W_ = Eigen::Vector2d::Zero();
  int turn_ = 1;
};

}  // namespace devices
