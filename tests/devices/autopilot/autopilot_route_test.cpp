// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/autopilot_route.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/math.hpp"

namespace {

using Eigen::Vector2d;

devices::Waypoint at(double x, double y) {
  devices::Waypoint point;
  point.p_W = {x, y};
  return point;
}

/// A craft that heads at once where it is commanded, through water that flows.  Its cross-track error in the end.
double drive(devices::Route& route, Vector2d p, double speed, const Vector2d& current, double time_s) {
  devices::Aim aim;
  Vector2d v(0, 0);
  for (double t = 0; t < time_s && !route.finished(); t += 0.1) {
    aim = route.aim(p, v, aim.heading_rad, 0.1);
    v = speed * Vector2d(std::cos(aim.heading_rad), std::sin(aim.heading_rad)) + current;
    p += 0.1 * v;
  }
  return aim.cross_track_m;
}

TEST(Route, HeadsForALineAtTheAngleOfItsLookahead) {
  devices::Route route({10, 0, 3});
  route.start({at(100, 0)}, false, {0, 0});
  const devices::Aim aim = route.aim({20, 10}, {0, 0}, 0, 0.1);
  EXPECT_NEAR(aim.cross_track_m, 10, 1e-12);
  EXPECT_NEAR(aim.heading_rad, -std::numbers::pi / 4, 1e-12);
  EXPECT_NEAR(aim.distance_m, std::hypot(80, 10), 1e-12);
}

TEST(Route, APointWithADepthIsAnotherStateThanOneWithAnAltitude) {
  const auto hash_of = [](const devices::Waypoint& point) {
    devices::Route route({10, 0, 3});
    route.start({point}, false, {0, 0});
    sim::StateArchive archive = sim::StateArchive::hasher();
    archive(route);
    return archive.hash();
  };
  devices::Waypoint deep = at(100, 0), high = at(100, 0);
  deep.depth_m = 5;
  high.altitude_m = 5;
  EXPECT_NE(hash_of(deep), hash_of(high));
}

TEST(Route, ACurrentLeavesAnErrorWithoutTheIntegralAndNoneWithIt) {
  const Vector2d across(0, 0.3);
  devices::Route plain({10, 0, 3}), integral({10, 0.3, 3});
  for (devices::Route* route : {&plain, &integral}) route->start({at(1e5, 0)}, false, {0, 0});
  // Crabbing against 0.3 of 1.5 m/s: e = Delta tan(asin(0.2)).
  EXPECT_NEAR(drive(plain, {0, 0}, 1.5, across, 400), 10 * std::tan(std::asin(0.2)), 1e-3);
  EXPECT_NEAR(drive(integral, {0, 0}, 1.5, across, 400), 0, 1e-3);
}

TEST(Route, NoCurrentBelowItsSpeedLeavesAnErrorWhereverItStarts) {
  for (const double current : {0.9, 1.1, -1.4})
    for (const double start_m : {0.0, 100.0, -100.0}) {
      devices::Route route({12, 0.5, 3});
      route.start({at(1e5, 0)}, false, {0, 0});
      // The slowest rate is kappa / Delta cos^3(drift), with sin(drift) = 1.4 / 1.6: 22 m exp(-2000 s x 0.0047/s) = 2
      // mm, and up to 1000 s before, for 4 Delta when it starts far away.
      EXPECT_NEAR(drive(route, {0, start_m}, 1.6, {0, current}, 3000), 0, 5e-3) << current << ' ' << start_m;
    }
}

TEST(Route, ComesToItsLegFromAfarWithoutGoingBeyond) {
  devices::Route route({12, 0.5, 3});
  route.start({at(1e5, 0)}, false, {0, 0});
  Vector2d p(0, 100), v(0, 0);
  devices::Aim aim;
  for (int i = 0; i < 6000; ++i) {
    aim = route.aim(p, v, aim.heading_rad, 0.1);
    v = 1.5 * Vector2d(std::cos(aim.heading_rad), std::sin(aim.heading_rad));
    p += 0.1 * v;
    // The first steps, without a speed, are all that the integral takes for drift.
    ASSERT_GT(p.y(), -0.1) << i;
  }
  EXPECT_NEAR(p.y(), 0, 1e-3);
}

TEST(Route, TheIntegralStandsInATurn) {
  devices::Route route({12, 0.5, 3});
  route.start({at(1000, 0)}, false, {0, 0});
  // For 10 s it goes to the left, across its leg, because its heading is not yet that of the leg.
  for (int i = 0; i < 100; ++i) route.aim({20, 0}, {0, 1.5}, std::numbers::pi / 2, 0.1);
  EXPECT_NEAR(route.aim({20, 0}, {1.5, 0}, 0, 0.1).heading_rad, 0, 1e-12);
}

TEST(Route, ACurrentThatItCannotStandIsForgottenWhenItIsOver) {
  devices::Route route({12, 0.5, 3});
  route.start({at(1e5, 0)}, false, {0, 0});
  // An hour in 2 m/s, with a speed of 1.6 m/s: 4 Delta is the most that the integral takes.
  Vector2d p(0, 0), v(0, 0);
  devices::Aim aim;
  const auto step = [&](double current) {
    aim = route.aim(p, v, aim.heading_rad, 0.1);
    v = 1.6 * Vector2d(std::cos(aim.heading_rad), std::sin(aim.heading_rad)) + Vector2d(0, current);
    p += 0.1 * v;
  };
  for (int i = 0; i < 36000; ++i) step(2);
  p = {0, 0};
  for (int i = 0; i < 6000; ++i) step(0);  // 48 m at 0.5 m/s, and 12 times Delta / kappa after that
  EXPECT_NEAR(p.y(), 0, 0.01);
}

TEST(Route, GoesFromPointToPointAndRoundWhenItLoops) {
  devices::Route route({5, 0.3, 2});
  route.start({at(20, 0), at(20, 20), at(0, 20)}, false, {0, 0});
  drive(route, {0, 0}, 1, {0, 0}, 200);
  EXPECT_TRUE(route.finished());
  EXPECT_EQ(route.index(), 2u);
  route.start({at(20, 0), at(20, 20), at(0, 20)}, true, {0, 0});
  drive(route, {0, 0}, 1, {0, 0}, 75);  // 20 + 20 + 20 m, and on to the first again
  EXPECT_FALSE(route.finished());
  EXPECT_EQ(route.index(), 0u);
}

TEST(Route, DoesNotTurnBackForAPointThatItMissed) {
  devices::Route route({10, 0, 3});
  route.start({at(50, 0), at(100, 0)}, false, {0, 0});
  route.aim({49, 20}, {0, 0}, 0, 0.1);
  EXPECT_EQ(route.index(), 0u);
  route.aim({51, 20}, {0, 0}, 0, 0.1);
  EXPECT_EQ(route.index(), 1u);
}

TEST(Route, TakesPointsOnOneSpotWithoutEnd) {
  devices::Route route({10, 0.3, 3});
  route.start({at(0, 0), at(0, 0), at(0, 0)}, true, {0, 0});
  const devices::Aim aim = route.aim({0, 0}, {0, 0}, 0, 0.1);
  EXPECT_TRUE(std::isfinite(aim.heading_rad));
}

TEST(Lawnmower, RunsParallelTracksFromItsCornerToTheLeft) {
  devices::Lawnmower lawnmower;
  lawnmower.corner_m = {10, 20};
  lawnmower.length_m = 100;
  lawnmower.width_m = 30;
  lawnmower.spacing_m = 10;
  const auto points = lawnmower.waypoints();
  ASSERT_EQ(points.size(), 8u);
  const Vector2d expected[] = {{10, 20}, {110, 20}, {110, 30}, {10, 30}, {10, 40}, {110, 40}, {110, 50}, {10, 50}};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR((points[i].p_W - expected[i]).norm(), 0, 1e-12) << i;
}

TEST(Lawnmower, TurnsWithItsDirectionAndCoversTheRightForANegativeWidth) {
  devices::Lawnmower lawnmower;
  lawnmower.direction_rad = sim::degrees_to_radians(90);
  lawnmower.length_m = 50;
  lawnmower.width_m = -25;
  lawnmower.spacing_m = 10;
  const auto points = lawnmower.waypoints();
  ASSERT_EQ(points.size(), 6u);  // tracks at 0, 10 and 20 m; 25 m holds no fourth
  EXPECT_NEAR((points[1].p_W - Vector2d(0, 50)).norm(), 0, 1e-12);
  EXPECT_NEAR((points[5].p_W - Vector2d(20, 50)).norm(), 0, 1e-12);
}

TEST(Circle, LeadsOutToTheCircleAndAlongIt) {
  devices::Circle left(10);
  left.start({0, 0}, {10, 0}, sim::degrees_to_radians(90));  // east of the center, going north: counter-clockwise
  EXPECT_NEAR(left.aim({10, 0}).heading_rad, sim::degrees_to_radians(90), 1e-12);
  EXPECT_NEAR(left.aim({0, 10}).heading_rad, sim::degrees_to_radians(180), 1e-12);
  // 5 m outside: atan(2 * 5 / 10) = 45 degrees inwards; at the center atan(-2) outwards of the tangent.
  EXPECT_NEAR(left.aim({15, 0}).heading_rad, sim::degrees_to_radians(135), 1e-12);
  EXPECT_NEAR(left.aim({0, 0}).heading_rad, sim::degrees_to_radians(90) - std::atan(2.0), 1e-12);
  EXPECT_NEAR(left.aim({15, 0}).cross_track_m, -5, 1e-12) << "outside is to the right of the track";
  devices::Circle right(10);
  right.start({0, 0}, {10, 0}, sim::degrees_to_radians(-90));
  EXPECT_NEAR(right.aim({10, 0}).heading_rad, sim::degrees_to_radians(-90), 1e-12);
  EXPECT_NEAR(right.aim({15, 0}).heading_rad, sim::degrees_to_radians(-135), 1e-12);
  EXPECT_NEAR(right.aim({15, 0}).cross_track_m, 5, 1e-12);
}

}  // namespace
