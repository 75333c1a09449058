// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/robots/striker.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace autonomy {

Striker::Striker(const Params& params) : params_(params), chase_(params.chase) {
  for (const double number : {params.aligned_rad, params.behind_m, params.memory_s})
    if (!(number > 0)) throw std::invalid_argument("angles, distances and times must be above 0");
}

void Striker::see(const std::optional<BallSighting>& sighting) {
  chase_.see(sighting);
  is_visible_ = sighting.has_value();
  if (sighting) sighting_ = sighting;
}

Striker::Vector Striker::ball_V() const {
  const double c = std::cos(*yaw_rad_), s = std::sin(*yaw_rad_);
  return {c * ball_W_.x + s * ball_W_.y, c * ball_W_.y - s * ball_W_.x};
}

/// Turns towards a point in the vehicle frame, and drives as far as it is ahead.
ChaseCommand Striker::drive_to(Vector target_V) const {
  const BallChase::Params& p = params_.chase;
  const double bearing_rad = std::atan2(target_V.y, target_V.x);
  const double ahead = std::clamp(1 - std::abs(bearing_rad) / p.slow_bearing_rad, 0.0, 1.0);
  return {ahead * p.approach_mps, std::clamp(p.turn_gain_per_s * bearing_rad, -p.max_turn_radps, p.max_turn_radps)};
}

/// Returns the command while the ball cannot be played towards the goal; none if it can, or is not known.
std::optional<ChaseCommand> Striker::drive_around(std::int64_t utime) const {
  const bool is_known = params_.goal_yaw_rad && yaw_rad_ && seen_utime_ &&
                        static_cast<double>(utime - *seen_utime_) * 1e-6 < params_.memory_s;
  if (!is_known || chase_.phase() == BallChase::Phase::kick) return std::nullopt;
  const Vector ball = ball_V();
  const double range_m = std::hypot(ball.x, ball.y), d = params_.behind_m;
  const double goal_rad = *params_.goal_yaw_rad - *yaw_rad_;
  const double off_rad =
      std::remainder(goal_rad - std::atan2(ball.y, ball.x), 2 * std::numbers::pi);  // from the ball to the goal
  if (std::abs(off_rad) < params_.aligned_rad) {
    if (is_visible_) return std::nullopt;
    ChaseCommand turn = drive_to(ball);  // to see it again
    turn.forward_mps = 0;
    return turn;
  }
  if (std::abs(off_rad) < std::numbers::pi / 2)
    return drive_to({ball.x - d * std::cos(goal_rad), ball.y - d * std::sin(goal_rad)});
  // The point behind the ball lies beyond it: the vehicle circles the ball at the distance d, on the side of that
  // point.
  const double side = off_rad > 0 ? -1 : 1, closer = std::clamp((range_m - d) / d, -1.0, 1.0);
  return drive_to({closer * ball.x - side * ball.y, closer * ball.y + side * ball.x});
}

ChaseCommand Striker::step(std::int64_t utime) {
  // The ball from here: as seen, or as it was before the way since.
  const double dt_s = last_utime_ ? static_cast<double>(utime - *last_utime_) * 1e-6 : 0;
  last_utime_ = utime;
  if (yaw_rad_ && sighting_) {
    const double angle_rad = *yaw_rad_ + sighting_->bearing_rad;
    ball_W_ = {sighting_->range_m * std::cos(angle_rad), sighting_->range_m * std::sin(angle_rad)};
    seen_utime_ = utime;
  } else if (yaw_rad_) {
    ball_W_.x -= forward_mps_ * dt_s * std::cos(*yaw_rad_);
    ball_W_.y -= forward_mps_ * dt_s * std::sin(*yaw_rad_);
  }
  sighting_.reset();

  const auto around = drive_around(utime);
  chase_.allow_kick(!params_.goal_yaw_rad || (yaw_rad_ && !around));
  const ChaseCommand chase = chase_.step(utime);
  const ChaseCommand command = around.value_or(chase);
  forward_mps_ = command.forward_mps;
  return command;
}

}  // namespace autonomy
