// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiment/score/map/true_map.hpp"
#include "experiment/score/scoring.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/occupancy_grid_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// A rover far from a crate of 1 m, whose map of 4 x 4 m has cells of 0.1 m.
struct MappedWorld {
  explicit MappedWorld(const std::string& metrics)
      : test(test::rover_world(
            "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, "
            "wheel_radius_m: 0.1, track_m: 0.5}\n",
            "  - {name: crate, fixed: true, position_m: [0, 0, 0.5], parts: [{shape: box, size_m: [1, 1, 1]}]}\n",
            "    position_m: [20, 2, 0]\n", "metrics:\n" + metrics)),
        scoring(test.world) {}

  void step(int times = 1) {
    for (int i = 0; i < times; ++i) {
      test.world.step();
      scoring.after_step();
    }
  }
  /// Publishes a map as the true one is now.
  void publish_truth() { publish(experiment::true_map(test.world, frame, 0.3)); }
  void publish(const experiment::GridMap& map) {
    shoal::occupancy_grid_t message{};
    message.utime = test.world.epoch_us() + test.world.now().count();
    message.cell_m = frame.cell_m;
    message.origin_m[0] = frame.origin_x_m;
    message.origin_m[1] = frame.origin_y_m;
    message.width = map.frame.width;
    message.height = map.frame.height;
    for (const experiment::Cell cell : map.cells)
      message.cells.push_back(cell == experiment::Cell::occupied ? 100 : cell == experiment::Cell::free ? 0 : -1);
    message.ncells = static_cast<std::int32_t>(message.cells.size());
    test.send("map", message);
    step();
  }
  void estimate(const sim::Vector3d& p_W, double yaw_rad) {
    shoal::estimate_t message{};
    message.utime = test.world.epoch_us() + test.world.now().count();
    message.position_m[0] = p_W.x();
    message.position_m[1] = p_W.y();
    message.yaw_rad = yaw_rad;
    test.send("est", message);
    step();
  }
  sim::Vector3d position_m() const { return test.world.find_vehicle("r1")->X_WV().translation(); }
  double figure(const std::string& name) const { return scoring.figures().at(name); }

  experiment::MapFrame frame = experiment::frame_of_area({-2, -2, 2, 2}, 0.1);
  test::TestWorld test;
  experiment::Scoring scoring;
};

constexpr const char* map_metric = "  - {name: m, type: map, channel: map, truth_period_s: 0.01}\n";
constexpr const char* path_metric = "  - {name: p, type: trajectory, vehicle: r1, channel: est, segment_m: 1}\n";
// A rover that stands still may creep by some 0.01 mm.
constexpr double creep_m = 1e-4;

TEST(MapMetric, OfTheTrueMapIsOne) {
  MappedWorld world(map_metric);
  world.publish_truth();
  EXPECT_EQ(world.figure("m.iou"), 1);
  EXPECT_EQ(world.figure("m.still_iou"), 1);
  EXPECT_EQ(world.figure("m.false_occupied_percent"), 0);
  EXPECT_EQ(world.figure("m.unknown_percent"), 0);
  EXPECT_TRUE(std::isnan(world.figure("m.stale_percent")));
  EXPECT_EQ(world.figure("m.maps"), 1);
}

TEST(MapMetric, ComparesEachMapWithTheTruthOfItsTime) {
  MappedWorld world(map_metric);
  const experiment::GridMap before = experiment::true_map(world.test.world, world.frame, 0.3);
  world.publish_truth();
  world.test.world.editor().remove_object("crate");
  world.step(100);
  // The old map has the 36 cells of the outline; within one cell of them there is nothing now.
  world.publish(before);
  EXPECT_EQ(world.figure("m.final_iou"), 0);
  // All cells of the outline have changed and are stale; of the inside the map knows nothing.
  EXPECT_EQ(world.figure("m.stale_percent"), 100);
  EXPECT_NEAR(world.figure("m.stale_age_s"), 100 * sim::to_seconds(world.test.world.step_time()), 0.02);
  world.publish_truth();
  EXPECT_EQ(world.figure("m.stale_percent"), 50);  // mean of two maps
  EXPECT_TRUE(std::isnan(world.figure("m.final_iou")));
}

TEST(MapMetric, IgnoresMapsOfAnotherFrameAndOtherMessages) {
  MappedWorld world(map_metric);
  world.publish_truth();
  world.publish(experiment::true_map(world.test.world, experiment::frame_of_area({-2, -2, 2, 3}, 0.1), 0.3));
  world.test.send("map", shoal::estimate_t{});
  world.step();
  EXPECT_EQ(world.figure("m.maps"), 1);
  EXPECT_EQ(world.scoring.bad_messages(), 2);
}

TEST(MapMetric, CountsMapsOfAPeriodAndKnowsWhatChangedBefore) {
  MappedWorld world("  - {name: m, type: map, channel: map, truth_period_s: 0.01, from_s: 0.1, until_s: 0.3}\n");
  const experiment::GridMap before = experiment::true_map(world.test.world, world.frame, 0.3);
  const double step_s = sim::to_seconds(world.test.world.step_time());
  world.publish(before);
  world.test.world.editor().remove_object("crate");
  world.step(static_cast<int>(0.2 / step_s));
  EXPECT_EQ(world.figure("m.maps"), 0);
  world.publish(before);
  EXPECT_EQ(world.figure("m.maps"), 1);
  EXPECT_EQ(world.figure("m.stale_percent"), 100);
  EXPECT_NEAR(world.figure("m.stale_age_s"), 0.2, 0.02);
  world.step(static_cast<int>(0.2 / step_s));
  world.publish(before);
  EXPECT_EQ(world.figure("m.maps"), 1);
}

TEST(MapMetric, IsRestoredWithItsRun) {
  MappedWorld world(map_metric);
  world.publish_truth();
  sim::StateArchive saver = sim::StateArchive::saver();
  world.scoring.visit_state(saver, experiment::History::whole);
  saver.end();
  const auto bytes = saver.take_bytes();
  const auto before = world.scoring.figures();
  experiment::GridMap wrong = experiment::true_map(world.test.world, world.frame, 0.3);
  std::fill(wrong.cells.begin(), wrong.cells.end(), experiment::Cell::free);
  world.publish(wrong);
  EXPECT_NE(world.figure("m.maps"), before.at("m.maps"));
  sim::StateArchive restorer = sim::StateArchive::restorer(bytes);
  world.scoring.visit_state(restorer, experiment::History::whole);
  EXPECT_EQ(world.figure("m.maps"), before.at("m.maps"));
  EXPECT_EQ(world.figure("m.iou"), before.at("m.iou"));
}

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
