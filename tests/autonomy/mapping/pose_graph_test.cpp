// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/pose_graph.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/autonomy/mapping/drawn_room.hpp"

namespace {

using autonomy::Alignment;
using autonomy::Pose2;
using autonomy::PoseGraph;
using autonomy::Vector2d;

Alignment measured(double x_m, double y_m, double yaw_rad, double information = 1) {
  return {{{x_m, y_m}, yaw_rad}, information * Eigen::Matrix3d::Identity()};
}

TEST(PoseGraph, SharesAContradictionByInformation) {
  // 1 m and 1 m, but 2.3 m over both: with equal information a third of 0.3 m each.
  PoseGraph graph;
  for (int i = 0; i < 3; ++i) graph.add_pose({{1.0 * i, 0}, 0});
  graph.add_measurement(0, 1, measured(1, 0, 0));
  graph.add_measurement(1, 2, measured(1, 0, 0));
  graph.add_measurement(0, 2, measured(2.3, 0, 0));
  graph.optimize(5);
  EXPECT_EQ(graph.poses()[0].p_W, Vector2d(0, 0));
  EXPECT_NEAR(graph.poses()[1].p_W.x(), 1.1, 1e-9);
  EXPECT_NEAR(graph.poses()[2].p_W.x(), 2.2, 1e-9);
}

TEST(PoseGraph, ClosesALoopWhoseTurnsWereMeasuredTooLarge) {
  // A square whose turns are 0.04 rad too large: closed, each is a quarter of the circle.
  PoseGraph graph;
  Pose2 pose;
  graph.add_pose(pose);
  const Pose2 side{{2, 0}, std::numbers::pi / 2 + 0.04};
  for (int i = 1; i < 4; ++i) {
    pose = autonomy::composed(pose, side);
    graph.add_pose(pose);
    graph.add_measurement(i - 1, i, measured(2, 0, side.yaw_rad));
  }
  graph.add_measurement(3, 0, measured(2, 0, std::numbers::pi / 2, 1e6));
  graph.add_measurement(0, 3, measured(0, 2, -std::numbers::pi / 2, 1e6));
  graph.optimize(20);
  EXPECT_LT((graph.poses()[2].p_W - Vector2d(2, 2)).norm(), 0.03);
  EXPECT_LT((graph.poses()[3].p_W - Vector2d(0, 2)).norm(), 1e-3);
}

TEST(PoseGraph, AMeasurementThatContradictsAllOthersHasLittleWeight) {
  PoseGraph graph;
  for (int i = 0; i < 2; ++i) graph.add_pose({{1.0 * i, 0}, 0});
  for (int i = 0; i < 5; ++i) graph.add_measurement(0, 1, measured(1, 0, 0, 1e4));
  graph.add_measurement(0, 1, measured(3, 0, 0, 1e4));
  graph.optimize(20);
  // Without weights (5 * 1 + 3) / 6 = 1.33.  Huber: 5 * 1e4 * (x - 1) = 3 * 1e2, x - 1 = 0.006.
  EXPECT_NEAR(graph.poses()[1].p_W.x(), 1.006, 1e-3);
}

}  // namespace
