// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "autonomy/missions/robots/ball_chase.hpp"

namespace autonomy {

/// Chases a ball as BallChase does, but kicks it towards a goal: while the ball is not between the vehicle and the side
/// of the goal, it drives around the ball to a point behind it.  It knows the heading of the goal and its own by a
/// compass.  Out of the image the ball is remembered for a while, moved by the commands since: a pure function of
/// sightings, headings and ticks in their order.
class Striker {
 public:
  struct Params {
    BallChase::Params chase;
    std::optional<double> goal_yaw_rad =
        {};                    ///< direction of the goal in the world frame; none: any, without a compass
    double aligned_rad = 0.4;  ///< the ball is played when its direction is that of the goal up to this
    double behind_m = 0.8;     ///< from the ball to the point behind it, and past which it drives around it, above 0
    double memory_s = 3;
  };

  /// Throws std::invalid_argument for distances that are not above 0, and those of BallChase.
  explicit Striker(const Params& params);
  /// Takes the result of an image; none: there was no ball in it.
  void see(const std::optional<BallSighting>& sighting);
  /// Takes its heading: yaw in the world frame.
  void head(double yaw_rad) { yaw_rad_ = yaw_rad; }
  /// Decides at the tick `utime`.  It searches until a heading is known.
  ChaseCommand step(std::int64_t utime);

  const BallChase& chase() const { return chase_; }

 private:
  struct Vector {
    double x, y;
  };
  ChaseCommand drive_to(Vector target_V) const;
  Vector ball_V() const;
  std::optional<ChaseCommand> drive_around(std::int64_t utime) const;

  Params params_;
  BallChase chase_;
  std::optional<double> yaw_rad_ = {};
  std::optional<BallSighting> sighting_ = {};  ///< since the last tick
  Vector ball_W_ = {0, 0};                     ///< from the vehicle to the ball, in the axes of the world
  std::optional<std::int64_t> seen_utime_ = {}, last_utime_ = {};
  bool is_visible_ = false;
  double forward_mps_ = 0;  ///< of the last command
};

}  // namespace autonomy
