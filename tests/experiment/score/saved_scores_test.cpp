// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/saved_scores.hpp"

#include <gmock/gmock.h>

#include "experiment/score/scoring.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/experiment/score/scored_worlds.hpp"

namespace {

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
