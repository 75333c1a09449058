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

using namespace scored_worlds;

/// What `save` saved goes back into `scoring`.
void restore_saved(experiment::Scoring& scoring, const sim::Bytes& bytes, experiment::History history) {
  auto archive = sim::StateArchive::restorer(bytes);
  scoring.visit_state(archive, history);
  archive.end();
}

sim::Bytes save(experiment::Scoring& scoring, experiment::History history) {
  auto archive = sim::StateArchive::saver();
  scoring.visit_state(archive, history);
  archive.end();
  return archive.take_bytes();
}

TEST(Scoring, GoesBackToWhatWasSaved) {
  for (const experiment::History history : {experiment::History::length, experiment::History::whole}) {
    ScoredWorld world;
    world.run_for(0.1);
    world.estimate("good", 1 + 3, 2 + 4);
    world.run_for(0.1);
    const sim::Bytes saved = save(world.scoring, history);
    const auto figures = world.scoring.figures();
    EXPECT_EQ(figures.at("good.samples"), 1);
    world.estimate("good", 5, 5);
    world.run_for(0.1);
    world.estimate("good", 5, 6);  // still in the mailbox
    EXPECT_EQ(world.scoring.figures().at("good.samples"), 2);
    restore_saved(world.scoring, saved, history);
    EXPECT_EQ(world.scoring.figures().at("good.samples"), 1);
    EXPECT_EQ(world.scoring.figures().at("good.rms_m"), figures.at("good.rms_m"));
    world.run_for(0.01);
    EXPECT_EQ(world.scoring.figures().at("good.samples"), 1) << "a message of another branch was read";
  }
}

TEST(Scoring, OnlyAWholeHistoryGoesIntoAnotherRun) {
  ScoredWorld world, other;
  world.run_for(0.1);
  world.estimate("good", 1 + 3, 2 + 4);
  world.run_for(0.1);
  restore_saved(other.scoring, save(world.scoring, experiment::History::whole), experiment::History::whole);
  EXPECT_EQ(other.scoring.figures().at("good.rms_m"), world.scoring.figures().at("good.rms_m"));
  ScoredWorld third;
  const sim::Bytes length = save(world.scoring, experiment::History::length);
  EXPECT_THROW(restore_saved(third.scoring, length, experiment::History::length), sim::SnapshotError);
}

}  // namespace
