// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/known_map/planner.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "shoal/message_codec.hpp"
#include "tests/autonomy/known_map/flat_map.hpp"
#include "tests/autonomy/mapping/drawn_room.hpp"

namespace {

using autonomy::Planner;
using autonomy::Pose2;
using autonomy::Vector2d;
using testing::HasSubstr;

constexpr std::int64_t planner_second = 1'000'000;

/// A ground of 20 x 12 m with a wall across it and two gaps, at y = 0 and y = 4, each 2 m wide.
shoal::occupancy_grid_t two_gaps() {
  shoal::occupancy_grid_t map = test::flat_map({-10, -6}, {10, 6}, 0.05);
  test::set_box(map, {-0.1, -6}, {0.1, -1});
  test::set_box(map, {-0.1, 1}, {0.1, 3});
  test::set_box(map, {-0.1, 5}, {0.1, 6});
  return map;
}

Planner::Params to(const std::vector<Vector2d>& goals_W) {
  Planner::Params params;
  params.goals_W = goals_W;
  return params;
}

/// The same walls for the lidar.
test::DrawnRoom walls() {
  test::DrawnRoom room;
  for (const auto& [low_m, high_m] : {std::pair{-6.0, -1.0}, {1.0, 3.0}, {5.0, 6.0}})
    room.add_box({-0.1, low_m}, {0.1, high_m});
  return room;
}

/// A planner whose vehicle is where it is put, and whose lidar sees `room`.
struct PlannerRun {
  explicit PlannerRun(const Planner::Params& params) : planner(params) { planner.receive(two_gaps()); }

  Planner::Decision tick() {
    utime += planner_second;
    shoal::estimate_t estimate{};
    estimate.utime = utime;
    estimate.position_m[0] = pose.p_W.x();
    estimate.position_m[1] = pose.p_W.y();
    estimate.yaw_rad = pose.yaw_rad;
    estimate.covariance_m2[0] = estimate.covariance_m2[4] = variance_m2;
    planner.receive(estimate);
    planner.receive(room.scan(pose, utime + scan_late_us));
    return planner.step(utime);
  }
  /// The y at which its path crosses the wall.
  double gap_y_m() const {
    for (std::size_t i = 1; i < planner.path_W().size(); ++i) {
      const Vector2d &a = planner.path_W()[i - 1], &b = planner.path_W()[i];
      if (a.x() < 0 && b.x() >= 0) return a.y() - a.x() / (b.x() - a.x()) * (b.y() - a.y());
    }
    return std::nan("");
  }

  Planner planner;
  Pose2 pose{{-5, 0}, 0};
  test::DrawnRoom room = walls();
  double variance_m2 = 0.01;
  std::int64_t utime = 0;
  std::int64_t scan_late_us = 0;  ///< behind the estimate
};

TEST(Planner, PlansToItsGoalsOneAfterAnother) {
  PlannerRun run(to({{5, 0}, {-5, 4}}));
  Planner::Decision decision = run.tick();
  ASSERT_TRUE(decision.path);
  EXPECT_EQ(decision.path->utime, run.utime);
  EXPECT_EQ(autonomy::path_of(*decision.path).front(), Vector2d(-5, 0));
  EXPECT_EQ(autonomy::path_of(*decision.path).back(), Vector2d(5, 0));
  EXPECT_NEAR(run.gap_y_m(), 0, 0.1);
  // The path stays while nothing changes.
  EXPECT_FALSE(run.tick().path);
  run.pose.p_W = {4.7, 0};
  decision = run.tick();
  EXPECT_EQ(decision.line, "reached (5.0, 0.0)");
  EXPECT_EQ(decision.path->n, 0);
  ASSERT_TRUE(run.tick().path);
  EXPECT_EQ(run.planner.path_W().back(), Vector2d(-5, 4));
  run.pose.p_W = {-5, 4};
  run.tick();
  EXPECT_FALSE(run.tick().path);
  EXPECT_EQ(run.planner.reached(), 2);
}

TEST(Planner, SeesByALidarOfTenScansASecond) {
  PlannerRun run(to({{5, 0}}));
  run.tick();
  run.room.add_box({-0.1, -0.8}, {0.1, 0.8});
  // The estimate at a scan comes a second after it.
  shoal::estimate_t estimate{};
  estimate.utime = run.utime + planner_second;
  estimate.position_m[0] = -5;
  estimate.covariance_m2[0] = estimate.covariance_m2[4] = 0.01;
  for (int i = 0; i <= 10; ++i)
    run.planner.receive(run.room.scan(run.pose, run.utime + planner_second + i * planner_second / 10));
  run.planner.receive(estimate);
  EXPECT_THAT(run.planner.step(run.utime + 2 * planner_second).line, HasSubstr("the path is blocked"));
}

TEST(Planner, RefusesAnEstimateOutsideOfAnyWorld) {
  PlannerRun run(to({{5, 0}}));
  shoal::estimate_t estimate{};
  estimate.position_m[1] = -1e29;
  EXPECT_THROW(run.planner.receive(estimate), shoal::MessageError);
}

TEST(Planner, CountsTheScansThatHaveTheTimeOfAnEstimate) {
  PlannerRun run(to({{5, 0}}));
  run.scan_late_us = 1;
  for (int i = 0; i < 3; ++i) run.tick();
  EXPECT_EQ(run.planner.used_scans(), 0);
  run.scan_late_us = 0;
  for (int i = 0; i < 3; ++i) run.tick();
  EXPECT_EQ(run.planner.used_scans(), 3);
}

TEST(Planner, TakesAnotherPathWhenTheLidarSeesAnObstacleInIt) {
  PlannerRun run(to({{5, 0}}));
  run.tick();
  ASSERT_NEAR(run.gap_y_m(), 0, 0.1);
  run.room.add_box({-0.1, -0.8}, {0.1, 0.8});
  const Planner::Decision decision = run.tick();
  EXPECT_THAT(decision.line, HasSubstr("the path is blocked at (-0.")) << decision.line;
  EXPECT_THAT(decision.line, HasSubstr(": another path"));
  EXPECT_NEAR(run.gap_y_m(), 4, 0.4);
  // It is gone, and beams pass through where it was.
  run.room = walls();
  for (int i = 0; i < 20; ++i) run.tick();
  run.pose.p_W = {-5, -3};  // off the path
  ASSERT_TRUE(run.tick().path);
  EXPECT_NEAR(run.gap_y_m(), 0, 0.4);
}

TEST(Planner, PlansAgainWhenTheMapChanges) {
  PlannerRun run(to({{5, 0}}));
  run.pose.yaw_rad = std::numbers::pi;  // what it sees itself would count more than the map
  run.tick();
  run.planner.receive(two_gaps());
  EXPECT_FALSE(run.tick().path);
  shoal::occupancy_grid_t map = two_gaps();
  test::set_box(map, {-0.1, -1}, {0.1, 1});
  run.planner.receive(map);
  EXPECT_TRUE(run.tick().path);
  EXPECT_NEAR(run.gap_y_m(), 4, 0.4);
}

TEST(Planner, SaysOnceThatThereIsNoPathAndGivesTheGoalUp) {
  PlannerRun run(to({{0, 2}, {5, 0}}));
  run.tick();
  const Planner::Decision decision = PlannerRun(to({{0, 2}})).tick();
  EXPECT_EQ(decision.line,
            "no path from (-5.0, 0.0) to (0.0, 2.0): the goal is 0.00 m from an obstacle, and must be 0.60 m");
  // It is to look around where it is.
  ASSERT_TRUE(decision.path);
  EXPECT_EQ(autonomy::path_of(*decision.path), std::vector<Vector2d>{Vector2d(-5, 0)});
  for (int i = 0; i < 120; ++i) EXPECT_EQ(run.tick().line, "");
  EXPECT_EQ(run.tick().line, "gives (0.0, 2.0) up");
  ASSERT_TRUE(run.tick().path);
  EXPECT_EQ(run.planner.path_W().back(), Vector2d(5, 0));
  EXPECT_EQ(run.planner.given_up(), 1);
  EXPECT_EQ(run.planner.reached(), 0);
}

TEST(Planner, PlansNothingWhileTheEstimateIsUncertainAndFromItsNewPlaceThen) {
  PlannerRun run(to({{5, 0}}));
  run.tick();
  run.variance_m2 = 4;
  run.pose.p_W = {-5, 4};
  EXPECT_FALSE(run.tick().path);
  run.variance_m2 = 0.01;
  ASSERT_TRUE(run.tick().path);
  EXPECT_EQ(run.planner.path_W().front(), Vector2d(-5, 4));
}

TEST(Planner, ForgetsOnlyWhatItSawShortlyBeforeTheEstimateBecameUncertain) {
  // Pallets in one gap, seen for long; then, carried without knowing, it believes to see some in the other one.
  PlannerRun run(to({{5, 0}}));
  run.room.add_box({-0.1, -0.8}, {0.1, 0.8});
  for (int i = 0; i < 10; ++i) run.tick();
  run.room = walls();
  run.room.add_box({-0.1, 3}, {0.1, 5});
  run.pose = {{-5, 4}, 0};
  for (int i = 0; i < 4; ++i) run.tick();
  ASSERT_TRUE(run.planner.path_W().empty());
  run.room = walls();
  run.pose = {{-5, 4}, std::numbers::pi};
  run.variance_m2 = 4;
  run.tick();
  run.variance_m2 = 0.01;
  run.tick();
  EXPECT_NEAR(run.gap_y_m(), 4, 0.4);
}

TEST(Planner, TakesGoalsFromAChannel) {
  PlannerRun run(to({}));
  EXPECT_FALSE(run.tick().path);
  shoal::waypoints_command_t goals = autonomy::path_message(0, {{5, 0}, {-5, 0}});
  goals.loop = 1;
  run.planner.receive(goals);
  for (const double x_m : {5.0, -5.0, 5.0, -5.0}) {
    ASSERT_TRUE(run.tick().path);
    EXPECT_EQ(run.planner.path_W().back(), Vector2d(x_m, 0));
    run.pose.p_W.x() = x_m;
    run.tick();
  }
  // No goals: it stands.
  run.tick();
  ASSERT_FALSE(run.planner.path_W().empty());
  run.planner.receive(autonomy::path_message(0, {}));
  const Planner::Decision decision = run.tick();
  ASSERT_TRUE(decision.path);
  EXPECT_EQ(decision.path->n, 0);
  EXPECT_THROW(run.planner.receive(autonomy::path_message(0, {{0, 0}, {1e8, 0}})), shoal::MessageError);
  EXPECT_THROW(run.planner.receive(autonomy::path_message(0, {{0, std::nan("")}})), shoal::MessageError);
}

TEST(PathGeometry, HasANearestPointAndPointsAhead) {
  const std::vector<Vector2d> path_W = {{0, 0}, {4, 0}, {4, 3}};
  const autonomy::OnPath nearest = autonomy::nearest_on(path_W, {3, 1.5});
  // 1 m from the second segment, 1.5 m from the first.
  EXPECT_EQ(nearest.p_W, Vector2d(4, 1.5));
  EXPECT_EQ(nearest.before, 1U);
  EXPECT_EQ(autonomy::nearest_on(path_W, {-1, -1}).p_W, Vector2d(0, 0));
  EXPECT_EQ(autonomy::ahead_on(path_W, {0, {1, 0}}, 2), Vector2d(3, 0));
  EXPECT_EQ(autonomy::ahead_on(path_W, {0, {1, 0}}, 5), Vector2d(4, 2));
  EXPECT_EQ(autonomy::ahead_on(path_W, {0, {1, 0}}, 50), Vector2d(4, 3));
  EXPECT_EQ(autonomy::ahead_on({{1, 2}}, autonomy::nearest_on({{1, 2}}, {0, 0}), 1), Vector2d(1, 2));
}

}  // namespace
