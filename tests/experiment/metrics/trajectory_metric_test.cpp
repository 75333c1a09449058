// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "messages/yaml/message_writer.hpp"
#include "shoal/estimate_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/experiment/metrics/mapped_world.hpp"

namespace {

using namespace mapped_world;

constexpr const char* path_metric = "  - {name: p, type: trajectory, vehicle: r1, channel: est, segment_m: 1}\n";

// A rover that stands still may creep by some 0.01 mm.
constexpr double creep_m = 1e-4;

TEST(TrajectoryMetric, IsTheRootMeanSquareOfTheErrors) {
  MappedWorld world(path_metric);
  world.step();
  const sim::Vector3d p = world.position_m();
  world.estimate(p + sim::Vector3d(0.3, 0, 7), 0.1);
  world.estimate(p + sim::Vector3d(0, -0.4, 0), -0.1);
  EXPECT_NEAR(world.figure("p.ate_m"), std::sqrt((0.09 + 0.16) / 2), creep_m);
  EXPECT_NEAR(world.figure("p.yaw_rms_deg"), sim::radians_to_degrees(0.1), 0.01);
  EXPECT_NEAR(world.figure("p.max_m"), 0.4, creep_m);
  EXPECT_EQ(world.figure("p.poses"), 2);
  EXPECT_TRUE(std::isnan(world.figure("p.segment_m")));
}

TEST(TrajectoryMetric, CountsPosesOfAPeriod) {
  MappedWorld world("  - {name: p, type: trajectory, vehicle: r1, channel: est, from_s: 0.1, until_s: 0.3}\n");
  const double step_s = sim::to_seconds(world.test.world.step_time());
  for (const double error_m : {9.0, 0.6, 5.0}) {
    world.estimate(world.position_m() + sim::Vector3d(error_m, 0, 0), 0);
    world.step(static_cast<int>(0.2 / step_s));
  }
  EXPECT_EQ(world.figure("p.poses"), 1);
  EXPECT_NEAR(world.figure("p.ate_m"), 0.6, creep_m);
  // Lost from 0.2 s to the end of the period.
  EXPECT_NEAR(world.figure("p.lost_s"), 0.1, 2 * step_s);
}

TEST(TrajectoryMetric, AlignmentRemovesARigidMotion) {
  MappedWorld world(path_metric);
  const Eigen::Rotation2Dd turn(0.3);
  // The vehicle is moved along an L; the estimate is the same L, turned by 0.3 rad and moved.
  for (const auto& [x, y] : {std::pair{20.0, 2.0}, {22.0, 2.0}, {24.0, 2.0}, {24.0, 5.0}}) {
    sim::Pose X_WV = sim::Pose::Identity();
    X_WV.translation() = sim::Vector3d(x, y, world.position_m().z());
    world.test.world.editor().move_vehicle("r1", X_WV);
    world.step();
    const Eigen::Vector2d p = turn * world.position_m().head<2>() + Eigen::Vector2d(3, -1);
    world.estimate({p.x(), p.y(), 0}, 0.3);
  }
  EXPECT_GT(world.figure("p.ate_m"), 1);
  EXPECT_NEAR(world.figure("p.aligned_ate_m"), 0, 1e-3);
}

TEST(TrajectoryMetric, LostTimeIsThatOfLargeErrors) {
  MappedWorld world(path_metric);
  world.step();
  const sim::Vector3d p = world.position_m();
  const double step_s = sim::to_seconds(world.test.world.step_time());
  world.estimate(p, 0);
  world.estimate(p + sim::Vector3d(0.6, 0, 0), 0);  // above 0.5 m, from here
  world.step(98);
  world.estimate(p + sim::Vector3d(0, 0.7, 0), 0);
  world.estimate(p, 0);
  world.step(50);
  EXPECT_NEAR(world.figure("p.lost_s"), 100 * step_s, 1e-9);
}

TEST(TrajectoryMetric, RefusesTimesAndNumbersThatCannotBe) {
  MappedWorld world(path_metric);
  world.step();
  world.estimate({std::nan(""), 0, 0}, 0);
  shoal::estimate_t old{};
  world.test.send("est", old);
  world.step();
  EXPECT_EQ(world.scoring.bad_messages(), 2);
  EXPECT_TRUE(std::isnan(world.figure("p.ate_m")));
}

}  // namespace
