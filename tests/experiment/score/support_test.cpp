// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/support.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiment/score/scoring.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/experiment/score/support_fixture.hpp"

namespace {

using namespace support_fixture;

using Eigen::Vector2d;

std::optional<experiment::Support> support_of(test::TestWorld& test, double settle_s = 2) {
  test.world.physics().watch_contacts(test.world.find_vehicle("t")->group());
  test.run_for(settle_s);
  return experiment::support_of(test.world, *test.world.find_vehicle("t"));
}

TEST(Support, TheHullOfPointsHasNoInnerOnes) {
  const auto hull = experiment::convex_hull_of({{0, 0}, {1, 0}, {0.5, 0}, {1, 1}, {0, 1}, {0.4, 0.6}, {0, 0}});
  ASSERT_EQ(hull.size(), 4u);
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i)
    area += (hull[i].x() * hull[(i + 1) % 4].y() - hull[i].y() * hull[(i + 1) % 4].x()) / 2;
  EXPECT_NEAR(area, 1, 1e-15);  // positive: counter-clockwise
  EXPECT_EQ(experiment::convex_hull_of({{0, 0}, {1, 1}, {2, 2}}).size(), 2u);
}

TEST(Support, MarginsAreDistancesToTheNearestEdge) {
  const std::vector<Vector2d> square{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  EXPECT_NEAR(experiment::margin_in(square, {0.5, 1}), 0.5, 1e-15);
  EXPECT_NEAR(experiment::margin_in(square, {2.5, 1}), -0.5, 1e-15);
  EXPECT_NEAR(experiment::margin_in(square, {3, 3}), -std::sqrt(2), 1e-15);  // to the corner
}

TEST(Support, OfATableAtRestIsTheRectangleOfItsFeet) {
  for (const double offset_m : {0.0, 0.15}) {
    test::TestWorld test(table_world(offset_m));
    const auto support = support_of(test);
    ASSERT_TRUE(support);
    EXPECT_EQ(support->polygon_W.size(), 4u);
    // 0.1 mm: the feet sink in by their softness, and the table tilts by it.
    EXPECT_NEAR(support->static_margin_m, std::min(0.2, 0.3 - offset_m), 1e-4);
    // At rest, zero-moment point and capture point are below the center of mass.
    EXPECT_NEAR(support->zmp_margin_m, support->static_margin_m, 1e-4);
    EXPECT_NEAR(support->capture_margin_m, support->static_margin_m, 1e-4);
    // Over the nearest edge, at a distance r from it and a height h, it rises by sqrt(r^2 + h^2) - h.
    const double r = std::min(0.2, 0.3 - offset_m);
    EXPECT_NEAR(support->nesm_m, std::hypot(r, 0.5) - 0.5, 1e-4);
  }
}

TEST(Support, TheCapturePointIsAheadByTheSpeed) {
  test::TestWorld test(table_world(0));
  ASSERT_TRUE(support_of(test));
  sim::Body& top = test.world.find_vehicle("t")->body("top");
  top.set_velocity_W({1, 0, 0}, {0, 0, 0});
  const auto support = experiment::support_of(test.world, *test.world.find_vehicle("t"));
  ASSERT_TRUE(support);
  // From 0.3 m behind the edge, v sqrt(z / g) with z = 0.5 m: 0.3 - 0.2258 = 0.0742 m.
  EXPECT_NEAR(support->capture_margin_m, 0.3 - std::sqrt(0.5 / 9.80665), 1e-4);
  EXPECT_NEAR(support->static_margin_m, 0.2, 1e-4);
}

TEST(Support, InTheAirThereIsNone) {
  test::TestWorld test(table_world(0));
  EXPECT_FALSE(support_of(test, 0));
}

}  // namespace
