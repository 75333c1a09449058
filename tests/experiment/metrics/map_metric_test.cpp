// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiment/score/map/true_map.hpp"
#include "experiment/score/scoring.hpp"
#include "messages/yaml/message_writer.hpp"
#include "shoal/estimate_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/experiment/metrics/mapped_world.hpp"

namespace {

using namespace mapped_world;

constexpr const char* map_metric = "  - {name: m, type: map, channel: map, truth_period_s: 0.01}\n";

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

}  // namespace
