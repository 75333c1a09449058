// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/velocity_obstacles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "autonomy/behaviors/avoid_behavior.hpp"
#include "autonomy/behaviors/make_behavior.hpp"
#include "autonomy/behaviors/vector_field_histogram.hpp"
#include "tests/autonomy/behaviors/avoiding_craft.hpp"

namespace {

using namespace avoiding_craft;

using autonomy::Course;
using autonomy::Motion;
using autonomy::Obstacle;
using autonomy::Vector2d;
using autonomy::VelocityObstacles;
using std::numbers::pi;

TEST(VelocityObstacles, ComeTooCloseWhenTheirEquationSaysSo) {
  const VelocityObstacles law(params);
  // Head on at 1.5 and 1 m/s from 40 m: 40 - 2.5 t - 1 = 4 at t = 14.
  const Obstacle boat{{40, 0}, {-1, 0}, 1};
  const auto ahead = law.outcome(eastwards(), Vector2d::Zero(), {1.5, 0}, {{boat}});
  EXPECT_NEAR(ahead.collision_s, 14, VelocityObstacles::step_s);
  // Beside it by 6 m: the smallest distance is 6 - 1, a meter more than it keeps.
  const Obstacle beside{{30, 6}, {-1, 0}, 1};
  const auto clear = law.outcome(eastwards(), Vector2d::Zero(), {1.5, 0}, {{beside}});
  EXPECT_TRUE(std::isinf(clear.collision_s));
  EXPECT_NEAR(clear.clearance_m, 1, 0.1);
}

TEST(VelocityObstacles, LetTheWaterCarryTheVehicle) {
  const VelocityObstacles law(params);
  // Heads north through water that sets it east at 1 m/s towards a pile 15 m away: 15 - t - 1 = 4 at t = 10.
  const Motion north{0, {0, 0}, {1, 0}, pi / 2};
  const Obstacle pile{{15, 0}, {0, 0}, 1};
  EXPECT_NEAR(law.outcome(north, {1, 0}, {0, pi / 2}, {{pile}}).collision_s, 10, VelocityObstacles::step_s);
}

TEST(VelocityObstacles, MakeTwoVehiclesThatMeetPassPortToPort) {
  VelocityObstacles east_law(params), west_law(params);
  AvoidingCraft east{eastwards()};
  AvoidingCraft west{{0, {60, 0}, {-1.5, 0}, pi}};
  double nearest_m = 1e9;
  for (int i = 0; i < 70; ++i) {
    const Obstacle west_now{west.motion.p_W, west.motion.v_W, 0.5};
    const Obstacle east_now{east.motion.p_W, east.motion.v_W, 0.5};
    const Course to_east = east_law.steer(east.motion, Vector2d::Zero(), {1.5, 0}, {{west_now}});
    const Course to_west = west_law.steer(west.motion, Vector2d::Zero(), {1.5, pi}, {{east_now}});
    east.go(to_east);
    west.go(to_west);
    const double distance_m = (east.motion.p_W - west.motion.p_W).norm();
    if (distance_m < nearest_m) {
      nearest_m = distance_m;
      // Each has the other to port: the eastbound one is south of the other.
      if (distance_m < 15) {
        EXPECT_LT(east.motion.p_W.y(), west.motion.p_W.y());
      }
    }
  }
  EXPECT_GT(nearest_m, params.keep_m);
  EXPECT_GT(east.motion.p_W.x(), west.motion.p_W.x());
}

}  // namespace
