// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include "experiment/score/scoring.hpp"
#include "messages/yaml/message_writer.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/experiment/score/scored_worlds.hpp"

namespace {

using namespace scored_worlds;

TEST(Scoring, JudgesByTheRulesOfTheWorld) {
  ScoredWorld world(
      "pass:\n"
      "  - good.max_m < 2\n"
      "  - good.max_m < 0.5\n"
      "  - good.max_m < 0.5 * late.max_m\n"
      "  - good.max_m < 0.2 * late.max_m\n"
      "  - good.max_m > 0.9\n"
      "  - late.max_m > 5 * good.max_m\n"
      "  - good.samples == 1\n"
      "  - good.samples == 2\n");
  world.run_for(1);
  world.estimate("good", 2, 2);  // 1 m off
  world.estimate("late", 5, 2);  // 4 m off
  world.run_for(0.01);
  const auto verdicts = world.scoring.verdicts();
  ASSERT_EQ(verdicts.size(), 8u);
  EXPECT_TRUE(verdicts[0].passed);
  EXPECT_FALSE(verdicts[1].passed);
  EXPECT_TRUE(verdicts[2].passed) << verdicts[2].rule;
  EXPECT_FALSE(verdicts[3].passed) << verdicts[3].rule;
  EXPECT_TRUE(verdicts[4].passed) << verdicts[4].rule;
  EXPECT_FALSE(verdicts[5].passed) << verdicts[5].rule;
  EXPECT_TRUE(verdicts[6].passed) << verdicts[6].rule;
  EXPECT_FALSE(verdicts[7].passed) << verdicts[7].rule;
  EXPECT_EQ(verdicts[7].rule, "good.samples == 2");
  EXPECT_EQ(verdicts[7].text(), "good.samples == 2 (left 1, right 2)");
  EXPECT_EQ(verdicts[3].rule, "good.max_m < 0.2 * late.max_m");
  // Rovers that stand still creep by some 0.01 mm.
  EXPECT_NEAR(verdicts[3].left, 1, 1e-4);
  EXPECT_NEAR(verdicts[3].right, 0.2 * 4, 1e-4);
  EXPECT_NEAR(verdicts[3].margin, 0.2 * 4 - 1, 1e-4);
  EXPECT_THAT(verdicts[3].result, testing::StartsWith("left "));
}

TEST(Scoring, FailsARuleWhenNoEstimateCame) {
  ScoredWorld world(
      "pass: [good.rms_m < 1000, good.rms_m > -1000, good.rms_m == 0, good.rms_m != 0, 0 * good.rms_m <= 1]\n");
  world.run_for(0.1);
  EXPECT_TRUE(std::isnan(world.scoring.figures().at("good.rms_m")));
  for (const auto& verdict : world.scoring.verdicts()) EXPECT_FALSE(verdict.passed) << verdict.rule;
  EXPECT_EQ(world.scoring.verdicts()[0].text(),
            "good.rms_m < 1000 (good.rms_m is none: no estimate was received on 'good')");
}

TEST(Scoring, ARuleOnAFigureThatIsNotThereSaysWhy) {
  ScoredWorld world(
      "  - {name: distance, type: distance, vehicle: r1, from_s: 100}\n"
      "  - {name: bumps, type: collisions, from_s: 100}\n"
      "  - {name: talk, type: messages, channel: nothing, from_s: 100}\n"
      "  - {name: gap, type: position_error, vehicle: r1, channel: good, from_s: 100}\n"
      "  - {name: link, type: delivery}\n"
      "  - {name: home, type: mission_time, vehicle: r1, position_m: [9, 9, 9], radius_m: 1}\n"
      "  - {name: first, type: messages, channel: nothing}\n"
      "  - {name: cost, type: bytes_per_metre, metric: good, against: late}\n"
      "pass:\n"
      "  - distance.travelled_m < 10\n"
      "  - bumps.count == 0\n"
      "  - talk.count == 0\n"
      "  - gap.max_gap_s < 10\n"
      "  - link.ratio > 0\n"
      "  - home.time_s < 100\n"
      "  - first.first_s < 100\n"
      "  - cost.bytes_per_metre < 100\n"
      "  - late.samples < late.rms_m\n"
      "  - good.rms_m > 0\n");
  world.run_for(1);
  world.test.send("good", shoal::twist_command_t{});
  world.run_for(0.01);
  std::vector<std::string> rules;
  for (const auto& verdict : world.scoring.verdicts()) {
    EXPECT_FALSE(verdict.passed) << verdict.rule;
    rules.push_back(verdict.text());
  }
  const std::string early = " is none: the run ended at 1.01 s, before from_s, 100 s";
  EXPECT_THAT(
      rules, testing::ElementsAre(
                 "distance.travelled_m < 10 (distance.travelled_m" + early + ")",
                 "bumps.count == 0 (bumps.count" + early + ")", "talk.count == 0 (talk.count" + early + ")",
                 "gap.max_gap_s < 10 (gap.max_gap_s" + early + ")",
                 "link.ratio > 0 (link.ratio is none: nothing was sent to these modems)",
                 "home.time_s < 100 (home.time_s is none: it did not happen)",
                 "first.first_s < 100 (first.first_s is none: no message was received on 'nothing')",
                 "cost.bytes_per_metre < 100 (cost.bytes_per_metre is none: the error of 'good' is not known to be the "
                 "smaller "
                 "one)",
                 "late.samples < late.rms_m (late.rms_m is none: no estimate was received on 'late' from 0.5 s on)",
                 "good.rms_m > 0 (good.rms_m is none: none of 1 message on 'good' could be used)"));
}

}  // namespace
