// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/resimulate/resimulated_run.hpp"

#include <gmock/gmock.h>

#include "experiment/run/version.hpp"
#include "tests/experiment/replay/replay_fixture.hpp"

namespace {

using testing::HasSubstr;

/// A record of a rover that a program drives for three seconds, run again.
class ResimulatedRunTest : public test::ReplayTest {
 protected:
  ResimulatedRunTest() { record(test::driven_world()); }

  std::unique_ptr<viewer::ResimulatedRun> run_again() const {
    viewer::ResimulatedRun::Options options;
    options.log = log;
    options.view.port = 0;
    auto run = std::make_unique<viewer::ResimulatedRun>(options, experiment::short_version());
    run->execute("speed", 0, "");
    return run;
  }
  static void advance_to(viewer::ResimulatedRun& run, std::int64_t step) {
    for (int i = 0; i < 10'000 && run.world().step_number() != step; ++i) run.advance();
    ASSERT_EQ(run.world().step_number(), step);
  }
  static std::string refusal(viewer::ResimulatedRun& run, const std::string& command, double value,
                             const std::string& text = "") {
    try {
      return "did it: " + run.execute(command, value, text);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }
};

TEST_F(ResimulatedRunTest, EndsInTheStateOfItsRecord) {
  const auto run = run_again();
  advance_to(*run, test::steps);
  EXPECT_EQ(run->world().state().hash(), state_hash);
  run->advance();
  EXPECT_EQ(run->world().step_number(), test::steps) << "the record ends here";
  EXPECT_THAT(refusal(*run, "resume", 0), HasSubstr("the record ends here"));
}

TEST_F(ResimulatedRunTest, IsPausedSteppedAndTakenBack) {
  const auto run = run_again();
  advance_to(*run, 250);
  run->execute("pause", 0, "");
  run->advance();
  EXPECT_EQ(run->world().step_number(), 250);
  run->execute("step", 5, "");
  for (int i = 0; i < 10; ++i) run->advance();
  EXPECT_EQ(run->world().step_number(), 255);
  // Back to a step between two snapshots, then on to the end.
  run->execute("rewind", 1.3, "");
  advance_to(*run, 125);
  EXPECT_TRUE(run->control().paused);
  EXPECT_EQ(run->control().branch, 0) << "a record has no branches";
  run->execute("resume", 0, "");
  advance_to(*run, test::steps);
  EXPECT_EQ(run->world().state().hash(), state_hash);
  EXPECT_THAT(refusal(*run, "rewind", -1), HasSubstr("needs a value above 0"));
  EXPECT_THAT(refusal(*run, "fly", 0),
              HasSubstr("'fly': this is a record, which cannot be changed: branch here first"));
}

TEST_F(ResimulatedRunTest, LeavesItsRecordForABranch) {
  const std::string higher = "{move: {name: crate, position_m: [3, 0, 2]}}";
  const auto run = run_again();
  advance_to(*run, 100);
  run->execute("pause", 0, "");
  EXPECT_THAT(refusal(*run, "do", 0, higher), HasSubstr("branch here first"));
  EXPECT_THAT(run->execute("branch", 0, ""), HasSubstr("branch 1; programs: recorded commands"));
  EXPECT_THAT(refusal(*run, "branch", 0), HasSubstr("this is branch 1 already"));
  run->execute("do", 0, higher);
  run->execute("resume", 0, "");
  advance_to(*run, test::steps);
  const std::uint64_t changed = run->world().state().hash();
  EXPECT_NE(changed, state_hash);
  // It continues after the end of its record, and back before that with the same change.
  advance_to(*run, test::steps + 50);
  run->execute("rewind", 1, "");
  advance_to(*run, 250);
  EXPECT_EQ(run->control().branch, 2);
  run->execute("resume", 0, "");
  advance_to(*run, test::steps);
  EXPECT_EQ(run->world().state().hash(), changed);
}

TEST_F(ResimulatedRunTest, ABranchWithoutAChangeIsItsRecord) {
  const auto run = run_again();
  advance_to(*run, 100);
  run->execute("branch", 0, "");
  advance_to(*run, test::steps);
  EXPECT_EQ(run->world().state().hash(), state_hash) << "the commands are those of the record";
}

}  // namespace
