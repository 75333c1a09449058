// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <limits>

#include "experiment/score/scoring.hpp"
#include "messages/yaml/message_writer.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/experiment/score/scored_worlds.hpp"

namespace {

using namespace scored_worlds;

TEST(Scoring, ComparesWithTheTruthAtTheTimeOfTheEstimate) {
  ScoredWorld world;
  shoal::twist_command_t forward{};
  forward.forward_mps = 0.5;
  world.test.send("r1.drive.cmd", forward);
  world.run_for(1);
  const double then_m = world.test.world.find_vehicle("r1")->X_WV().translation().x();
  world.run_for(2);
  world.estimate("good", then_m, 2, 2.0);
  world.run_for(0.01);
  EXPECT_NEAR(world.scoring.figures().at("good.final_m"), 0, 1e-4);
  world.estimate("good", then_m, 2);
  world.run_for(0.01);
  EXPECT_NEAR(world.scoring.figures().at("good.final_m"), 1.0, 0.01);  // 0.5 m/s for 2 s
}

TEST(Scoring, KnowsTheTruthAtTheStart) {
  ScoredWorld world;
  world.estimate("good", 1, 2);
  world.run_for(0.01);
  EXPECT_NEAR(world.scoring.figures().at("good.final_m"), 0, 1e-4);
}

TEST(Scoring, SurvivesTimesAtTheEndsOfTheirRange) {
  ScoredWorld world;
  world.run_for(0.1);
  for (const std::int64_t utime :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    shoal::pose_t pose{};
    pose.utime = utime;
    world.test.send("good", pose);
  }
  world.run_for(0.01);
  EXPECT_EQ(world.scoring.bad_messages(), 2);
}

}  // namespace
