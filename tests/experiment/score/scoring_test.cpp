// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/scoring.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "shoal/pose_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// A rover that stands at (1, 2); `more`: keys of the world, after two metrics of its position.
std::string scored_world(const std::string& more = "") {
  return test::rover_world(
      "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, "
      "wheel_radius_m: 0.1, track_m: 0.5}\n",
      "", "    position_m: [1, 2, 0]\n",
      "metrics:\n"
      "  - {name: good, type: position_error, vehicle: r1, channel: good}\n"
      "  - {name: late, type: position_error, vehicle: r1, channel: late, from_s: 0.5}\n" +
          more);
}

struct ScoredWorld {
  explicit ScoredWorld(const std::string& more = "") : test(scored_world(more)), scoring(test.world) {}

  void run_for(double time_s) {
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      test.world.step();
      scoring.after_step();
    }
  }
  /// An estimate for a time that lies `age_s` back.
  void estimate(const std::string& channel, double x_m, double y_m, double age_s = 0) {
    shoal::pose_t pose{};
    pose.utime = test.world.epoch_us() + test.world.now().count() - sim::from_seconds(age_s).count();
    pose.pos[0] = x_m;
    pose.pos[1] = y_m;
    pose.pos[2] = 77;  // heights do not count
    test.send(channel, pose);
  }

  test::TestWorld test;
  experiment::Scoring scoring;
};

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
