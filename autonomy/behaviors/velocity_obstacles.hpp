// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "autonomy/behaviors/avoidance_law.hpp"

namespace autonomy {

/// Generalized velocity obstacles (Wilkie, van den Berg, Manocha, IROS 2009): of a set of controls, here a heading and
/// a speed, takes the one with the lowest cost; the own motion under a control is that of a vehicle that turns at a
/// limited rate, and obstacles keep their velocities.  A control that comes closer than `keep_m` to an obstacle after
/// the time t costs w / t in addition to its distance from the desired velocity (the penalty of van den Berg, Lin,
/// Manocha, Reciprocal velocity obstacles, ICRA 2008).  A turn to port costs a little more than one to starboard, so
/// that two vehicles that meet pass port to port (rule 14 of the COLREGs).
class VelocityObstacles final : public AvoidanceLaw {
 public:
  static constexpr double step_s = 0.5;
  static constexpr int headings = 36;

  explicit VelocityObstacles(const AvoidanceParams& params) : params_(params) {}
  Course steer(const Motion& own, const Vector2d& drift_W, const Course& desired,
               std::span<const Obstacle> obstacles) override;
  std::unique_ptr<AvoidanceLaw> clone() const override { return std::make_unique<VelocityObstacles>(*this); }

  /// Predicted outcome of a control.
  struct Outcome {
    double collision_s;  ///< time when it comes too close; infinity: it does not
    double clearance_m;  ///< smallest distance to the edge of an obstacle beyond `keep_m`
  };
  /// Still obstacles count on the distance of the control only.
  Outcome outcome(const Motion& own, const Vector2d& drift_W, const Course& control,
                  std::span<const Obstacle> obstacles) const;

 private:
  AvoidanceParams params_;
  double last_turn_rad_ = 0;  ///< of the control chosen last, from the desired heading
};

}  // namespace autonomy
