// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/formation_behavior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/base/math.hpp"
#include "tests/autonomy/second.hpp"

namespace {

using autonomy::Course;
using autonomy::formation_offset_m;
using autonomy::FormationBehavior;
using autonomy::Motion;
using autonomy::turned;
using autonomy::Vector2d;
using std::numbers::pi;
using test::second;

TEST(Formation, HasPlacesBesideAndBehindItsLeader) {
  EXPECT_EQ(formation_offset_m("line", 1, 20), Vector2d(0, 20));
  EXPECT_EQ(formation_offset_m("line", 4, 20), Vector2d(0, -40));
  EXPECT_EQ(formation_offset_m("column", 3, 20), Vector2d(-60, 0));
  EXPECT_EQ(formation_offset_m("vee", 2, 20), Vector2d(-20, -20));
  EXPECT_EQ(formation_offset_m("vee", 3, 20), Vector2d(-40, 40));
  EXPECT_THROW(formation_offset_m("ring", 1, 20), std::invalid_argument);
  EXPECT_THROW(formation_offset_m("vee", 0, 20), std::invalid_argument);
}

FormationBehavior::Params params_of(const Vector2d& offset_m) {
  FormationBehavior::Params params;
  params.leader = "leader";
  params.offset_m = offset_m;
  return params;
}

TEST(Formation, CommandsTheVelocityOfConstantBearingGuidance) {
  FormationBehavior behavior(params_of({0, 10}));
  behavior.receive_state("leader", {second, {0, 0}, {1, 0}});
  // The place is (0, 10), the error e = (0, 12), U = 1.2, D = 9: v = (1, 1.2 * 12 / sqrt(144 + 81)) = (1, 0.96).
  const Course course = behavior.steer({second, {0, -2}, {1, 0}, 0});
  EXPECT_NEAR(course.speed_mps, std::hypot(1, 0.96), 1e-12);
  EXPECT_NEAR(course.heading_rad, std::atan2(0.96, 1), 1e-12);
}

TEST(Formation, StopsWithoutAStateOfItsLeaderOrWithAnOldOne) {
  FormationBehavior behavior(params_of({0, 10}));
  EXPECT_EQ(behavior.steer({second, {0, 0}, {1, 0}, 0.3}).speed_mps, 0);
  EXPECT_NE(behavior.remark(), "");
  behavior.receive_state("other", {second, {0, 0}, {1, 0}});
  EXPECT_FALSE(behavior.place_W(second));
  behavior.receive_state("leader", {second, {0, 0}, {1, 0}});
  EXPECT_EQ(behavior.remark(), "");
  EXPECT_TRUE(behavior.place_W(61 * second));
  EXPECT_FALSE(behavior.place_W(61 * second + 1));
}

TEST(Formation, SlowsDownAheadOfItsPlaceAndDoesNotTurnAround) {
  FormationBehavior behavior(params_of({-20, 0}));
  behavior.receive_state("leader", {second, {0, 0}, {1, 0}});
  const Course course = behavior.steer({second, {40, 0}, {1, 0}, 0});
  EXPECT_NEAR(course.heading_rad, 0, 1e-9);
  EXPECT_LT(course.speed_mps, 0.5);
}

/// A craft that takes its commands through water that moves.
TEST(Formation, KeepsItsPlaceInACurrentAcrossItsCourse) {
  FormationBehavior behavior(params_of({-20, 20}));
  const Vector2d current_W(0, 0.2);
  Motion own{second, {-30, 30}, {0, 0}, 0};
  double worst_m = 0;
  for (int i = 0; i < 800; ++i) {
    const double t_s = 0.5 * i;
    // The leader reports every 5 s what was true 4 s ago.
    if (i % 10 == 0) behavior.receive_state("leader", {second + (i - 8) * second / 2, {1.2 * (t_s - 4), 0}, {1.2, 0}});
    const Course course = behavior.steer(own);
    own.yaw_rad += std::clamp(sim::wrap_angle(course.heading_rad - own.yaw_rad), -0.15, 0.15);
    own.v_W = turned({course.speed_mps, 0}, own.yaw_rad) + current_W;
    own.p_W += 0.5 * own.v_W;
    own.utime += second / 2;
    const Vector2d place_W(1.2 * (t_s + 0.5) - 20, 20);
    if (i > 200) worst_m = std::max(worst_m, (own.p_W - place_W).norm());
  }
  // Without the estimate of the current it would be off by D c / sqrt(U^2 - c^2), 1.5 m.
  EXPECT_LT(worst_m, 0.5);
}

}  // namespace
