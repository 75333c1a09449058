// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/scoring.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "messages/yaml/message_writer.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/experiment/score/scored_worlds.hpp"

namespace {

using namespace scored_worlds;

TEST(Scoring, SumsUpTheErrors) {
  ScoredWorld world;
  world.run_for(0.1);
  world.estimate("good", 1 + 3, 2 + 4);  // 5 m off
  world.estimate("good", 1, 2 + 1);      // 1 m off
  world.run_for(0.1);
  const auto figures = world.scoring.figures();
  // A rover that stands still may creep by some 0.01 mm.
  EXPECT_NEAR(figures.at("good.rms_m"), std::sqrt((25.0 + 1.0) / 2), 1e-4);
  EXPECT_NEAR(figures.at("good.max_m"), 5, 1e-4);
  EXPECT_NEAR(figures.at("good.final_m"), 1, 1e-4);
  EXPECT_EQ(figures.at("good.samples"), 2);
  EXPECT_EQ(world.scoring.bad_messages(), 0);
}

TEST(Scoring, LeavesOutWhatCameBeforeItsTime) {
  ScoredWorld world;
  world.run_for(0.49);
  world.estimate("late", 9, 9);
  world.run_for(0.02);
  world.estimate("late", 1, 2);
  world.run_for(0.01);
  EXPECT_EQ(world.scoring.figures().at("late.samples"), 1);
  EXPECT_NEAR(world.scoring.figures().at("late.max_m"), 0, 1e-4);
  EXPECT_EQ(world.scoring.bad_messages(), 0);
}

TEST(Scoring, CountsAndIgnoresBadEstimates) {
  ScoredWorld world;
  world.run_for(11);
  world.estimate("good", std::numeric_limits<double>::quiet_NaN(), 0);
  world.estimate("good", 1, 2, -1.5);  // from the future: a clock may be 1 s ahead
  world.estimate("good", 1, 2, 10.5);  // too late: the truth is kept for 10 s
  world.estimate("good", 1, 2, 12);    // before the run
  world.test.bus.publish("good", sim::Bytes(30), world.test.world.now());
  world.test.bus.publish("good", sim::Bytes(), world.test.world.now());
  world.test.send("good", shoal::twist_command_t{});
  world.run_for(0.01);
  EXPECT_EQ(world.scoring.bad_messages(), 7);
  EXPECT_EQ(world.scoring.figures().at("good.samples"), 0);
}

}  // namespace
