// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/avoid_behavior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "autonomy/behaviors/make_behavior.hpp"
#include "autonomy/behaviors/vector_field_histogram.hpp"
#include "autonomy/behaviors/velocity_obstacles.hpp"
#include "tests/autonomy/behaviors/avoiding_craft.hpp"

namespace {

using namespace avoiding_craft;

using autonomy::Course;
using autonomy::Motion;
using autonomy::turned;
using autonomy::Vector2d;
using std::numbers::pi;
using test::second;

TEST(AvoidBehavior, FollowsItsRouteAroundWhatTheScanShows) {
  autonomy::ObstacleTracks::Params tracks;
  tracks.range_m = 50;
  autonomy::AvoidBehavior behavior(autonomy::make_route({{100, 0}}, 1.5, false),
                                   autonomy::Avoidance(autonomy::make_avoidance("velocity_obstacles", params), tracks));
  const Vector2d pile_W(50, 0);
  AvoidingCraft craft{eastwards()};
  craft.motion.utime = second;
  double nearest_m = 1e9;
  for (int i = 0; i < 300 && !behavior.finished(); ++i) {
    // One beam in each degree; the pile has a radius of 1 m.
    autonomy::Scan scan{std::vector<float>(181, 100.0f), -pi / 2, pi / 180};
    const Vector2d d_B = turned(pile_W - craft.motion.p_W, -craft.motion.yaw_rad);
    for (std::size_t k = 0; k < 181; ++k) {
      const Vector2d beam_B = turned({1, 0}, -pi / 2 + static_cast<double>(k) * pi / 180);
      const double along_m = d_B.dot(beam_B);
      if (along_m > 0 && d_B.squaredNorm() - along_m * along_m < 1) scan.ranges_m[k] = static_cast<float>(along_m - 1);
    }
    behavior.receive_scan(scan, craft.motion);
    craft.go(behavior.steer(craft.motion));
    nearest_m = std::min(nearest_m, (craft.motion.p_W - pile_W).norm() - 1);
  }
  EXPECT_TRUE(behavior.finished());
  EXPECT_GT(nearest_m, params.keep_m - 1);
}

TEST(AvoidBehavior, IsCopiedWithItsState) {
  autonomy::AvoidBehavior behavior(autonomy::make_route({{100, 0}}, 1.5, false),
                                   autonomy::Avoidance(autonomy::make_avoidance("velocity_obstacles", params), {}));
  const Motion own{second, {0, 0}, {1.5, 0}, 0};
  autonomy::Scan scan{std::vector<float>(21, 100.0f), -pi / 18, pi / 180};
  for (std::size_t k = 8; k < 13; ++k) scan.ranges_m[k] = 12;
  behavior.receive_scan(scan, own);
  const auto copy = behavior.clone();
  const Course course = behavior.steer(own);
  EXPECT_NE(course.heading_rad, 0);
  const Course again = copy->steer(own);
  EXPECT_EQ(course.heading_rad, again.heading_rad);
  EXPECT_EQ(course.speed_mps, again.speed_mps);
}

}  // namespace
