// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "autonomy/behaviors/avoid_behavior.hpp"
#include "autonomy/behaviors/make_behavior.hpp"
#include "autonomy/behaviors/vector_field_histogram.hpp"
#include "autonomy/behaviors/velocity_obstacles.hpp"
#include "sim/base/math.hpp"
#include "tests/autonomy/second.hpp"

namespace avoiding_craft {

inline constexpr autonomy::AvoidanceParams params{
    .keep_m = 4, .horizon_s = 15, .turn_radps = 0.3, .speed_time_s = 2, .speed_min_mps = 0};

/// Heads east at 1.5 m/s.
inline autonomy::Motion eastwards(const autonomy::Vector2d& p_W = {0, 0}) {
  return {0, p_W, {1.5, 0}, 0};
}

/// A craft as the laws assume it.
struct AvoidingCraft {
  autonomy::Motion motion;
  void go(const autonomy::Course& course) {
    constexpr double dt_s = 0.5;
    motion.yaw_rad += std::clamp(sim::wrap_angle(course.heading_rad - motion.yaw_rad), -0.3 * dt_s, 0.3 * dt_s);
    const double speed_mps = motion.v_W.norm() + (course.speed_mps - motion.v_W.norm()) * dt_s / 2;
    motion.v_W = autonomy::turned({speed_mps, 0}, motion.yaw_rad);
    motion.p_W += motion.v_W * dt_s;
    motion.utime += test::second / 2;
  }
};

}  // namespace avoiding_craft
