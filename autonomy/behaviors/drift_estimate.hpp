// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "autonomy/behaviors/helm_behavior.hpp"
#include "sim/base/math.hpp"

namespace autonomy {

/// Motion of the water: the difference between the velocity over ground and the commanded speed along the heading, in a
/// first-order low pass.  It is updated on a steady course only: a vehicle that turns, or takes another speed, does not
/// move as commanded.
class DriftEstimate {
 public:
  static constexpr double time_s = 15;
  static constexpr double steady_after_s = 5;
  static constexpr double max_mps = 1;

  /// Call before each decision, with its time, motion and heading.
  void update(const Motion& own) {
    const double dt_s = utime_ ? seconds(own.utime - *utime_) : 0;
    utime_ = own.utime;
    if (!own.v_W.allFinite() || !std::isfinite(own.yaw_rad) || dt_s <= 0) return;
    const bool on_course = std::abs(sim::wrap_angle(command_.heading_rad - own.yaw_rad)) < course_error_rad;
    steady_s_ = on_course && !changed_ ? steady_s_ + dt_s : 0;
    if (steady_s_ < steady_after_s) return;
    const Vector2d seen_W = own.v_W - turned({command_.speed_mps, 0}, own.yaw_rad);
    drift_W_ += std::min(1.0, dt_s / time_s) * (seen_W - drift_W_);
    if (drift_W_.norm() > max_mps) drift_W_ *= max_mps / drift_W_.norm();
  }
  /// Call after each decision.
  void command(const Course& command) {
    changed_ = std::abs(command.speed_mps - command_.speed_mps) > speed_change_mps;
    command_ = command;
  }
  const Vector2d& drift_W() const { return drift_W_; }

 private:
  static constexpr double course_error_rad = 0.15;
  static constexpr double speed_change_mps = 0.1;

  Vector2d drift_W_ = Vector2d::Zero();
  std::optional<std::int64_t> utime_;
  Course command_;
  bool changed_ = true;
  double steady_s_ = 0;
};

}  // namespace autonomy
