// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/scores_message.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/experiment/score/scored_worlds.hpp"

namespace {

using testing::ElementsAre;

TEST(ScoresMessage, HasTheFiguresAndBothSidesOfEachRule) {
  scored_worlds::ScoredWorld world("pass: [good.samples > 1, good.samples <= 2]\n");
  world.run_for(0.1);
  world.estimate("good", 1, 2);
  world.run_for(0.1);
  shoal::sim_scores_t message{};
  experiment::fill_scores(world.scoring, message);
  experiment::fill_scores(world.scoring, message);  // it replaces what was there
  ASSERT_EQ(message.count, static_cast<std::int32_t>(world.scoring.figures().size()));
  const auto found = std::find(message.figure.begin(), message.figure.end(), "good.samples");
  ASSERT_NE(found, message.figure.end());
  EXPECT_EQ(message.value[static_cast<std::size_t>(found - message.figure.begin())], 1);
  EXPECT_EQ(message.rules, 2);
  EXPECT_THAT(message.rule, ElementsAre("good.samples > 1", "good.samples <= 2"));
  EXPECT_THAT(message.holds, ElementsAre(0, 1));
  EXPECT_THAT(message.left, ElementsAre(1, 1));
  EXPECT_THAT(message.right, ElementsAre(1, 2));
}

}  // namespace
