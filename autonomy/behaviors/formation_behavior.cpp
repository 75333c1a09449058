// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/formation_behavior.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace autonomy {

namespace {

/// Speed below which the course is only noise.
constexpr double course_min_mps = 0.2;

}  // namespace

std::vector<std::string> formation_names() {
  return {"line", "column", "vee"};
}

Vector2d formation_offset_m(const std::string& name, int place, double spacing_m) {
  if (place < 1) throw std::invalid_argument("the places of a formation are counted from 1");
  const double row = (place + 1) / 2;
  const double side = place % 2 == 1 ? 1 : -1;
  if (name == "line") return {0, side * row * spacing_m};
  if (name == "column") return {-place * spacing_m, 0};
  if (name == "vee") return {-row * spacing_m, side * row * spacing_m};
  throw std::invalid_argument("there is no formation '" + name + "'");
}

void FormationBehavior::receive_state(const std::string& vehicle, const Motion& other) {
  if (vehicle != params_.leader) return;
  constexpr std::int64_t oldest_us = 60'000'000;  // older: the clock of the leader was set back
  if (leader_ && other.utime <= leader_->utime && other.utime > leader_->utime - oldest_us) return;
  leader_ = other;
  if (other.v_W.norm() > course_min_mps) leader_course_rad_ = std::atan2(other.v_W.y(), other.v_W.x());
}

std::string FormationBehavior::remark() const {
  return leader_ ? "" : "it has received no message from '" + params_.leader + "', the leader of its formation";
}

std::optional<Vector2d> FormationBehavior::place_W(std::int64_t utime) const {
  if (!leader_) return std::nullopt;
  const double age_s = seconds(utime - leader_->utime);
  if (std::abs(age_s) > params_.discard_after_s) return std::nullopt;
  return Vector2d(leader_->p_W + leader_->v_W * age_s + turned(params_.offset_m, leader_course_rad_));
}

Course FormationBehavior::steer(const Motion& own) {
  drift_.update(own);
  const Course course = course_for(own);
  drift_.command(course);
  return course;
}

Course FormationBehavior::course_for(const Motion& own) const {
  const auto goal_W = place_W(own.utime);
  if (!goal_W) return {0, std::isfinite(own.yaw_rad) ? own.yaw_rad : std::atan2(own.v_W.y(), own.v_W.x())};
  const Vector2d error_W = *goal_W - own.p_W;
  const double D = params_.distance_m;
  const Vector2d over_ground_W =
      leader_->v_W + params_.approach_mps / std::sqrt(error_W.squaredNorm() + D * D) * error_W;
  Vector2d through_water_C = turned(over_ground_W - drift_.drift_W(), -leader_course_rad_);
  // While the leader moves, ahead of its place the vehicle slows down and keeps its course.
  if (leader_->v_W.norm() > course_min_mps) through_water_C.x() = std::max(through_water_C.x(), params_.speed_min_mps);
  const Vector2d through_water_W = turned(through_water_C, leader_course_rad_);
  return {std::min(through_water_W.norm(), params_.speed_max_mps),
          std::atan2(through_water_W.y(), through_water_W.x())};
}

}  // namespace autonomy
