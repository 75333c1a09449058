// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <spdlog/fmt/fmt.h>

#include "experiment/process/world_programs.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/version.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/world/world_state.hpp"
#include "tests/own_ports.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"
#include "viewer/resimulate/resimulated_run.hpp"

// A record whose branches start the programs of its world again, and its scores.

namespace {

using testing::HasSubstr;

/// Figures with all digits; a figure without data equals itself.
std::map<std::string, std::string> texts_of(const experiment::Figures& figures) {
  std::map<std::string, std::string> texts;
  for (const auto& [name, value] : figures) texts[name] = fmt::format("{}", value);
  return texts;
}

/// A record of the shipped Segway, which another program balances in lockstep.
class RelaunchedRun : public testing::Test {
 protected:
  static constexpr std::int64_t steps = 800;

  void SetUp() override {
    sim::LoadOptions load;
    load.encode_message = shoal::encode_own_message;
    sim::LoadedWorld loaded = sim::load_world(test_support::source_path("worlds/segway.yaml"), load);
    experiment::read_programs(loaded, {});
    experiment::RunOptions options;
    options.launch = options.quiet = true;
    options.lcm_url = test_support::own_url();
    options.record = log;
    options.speed = 0;
    options.duration_s = 0.005 * steps;
    recorded = experiment::run_world(loaded, options);
    ASSERT_EQ(recorded.steps, steps) << recorded.error;
  }
  std::unique_ptr<viewer::ResimulatedRun> run_again(bool launch) const {
    viewer::ResimulatedRun::Options options;
    options.log = log;
    options.view.port = 0;
    options.launch = launch;
    options.lcm_url = test_support::own_url();
    auto run = std::make_unique<viewer::ResimulatedRun>(options, experiment::short_version());
    run->execute("speed", 0, "");
    return run;
  }
  /// Advances until the step is there on a branch; a branch begins when its programs have followed the record.
  static void advance_to(viewer::ResimulatedRun& run, std::int64_t step, std::int32_t branch) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while ((run.world().step_number() != step || run.control().branch != branch) &&
           std::chrono::steady_clock::now() < end)
      run.advance();
    ASSERT_EQ(run.world().step_number(), step);
    ASSERT_EQ(run.control().branch, branch);
  }

  test_support::ScratchFolder folder;
  std::string log = folder.file("segway.lcm");
  experiment::Summary recorded;
};

TEST_F(RelaunchedRun, ABranchWithItsProgramsEndsAsTheRunDid) {
  const auto run = run_again(true);
  EXPECT_STREQ(run->programs(), "recorded commands");
  EXPECT_THAT(run->commands(), testing::ElementsAre(HasSubstr("shoal-balance")));
  advance_to(*run, 250, 0);
  EXPECT_THAT(run->execute("branch", 0, ""), HasSubstr("programs: restarted programs"));
  advance_to(*run, 251, 1);
  advance_to(*run, steps, 1);
  EXPECT_EQ(run->world().state().hash(), recorded.state_hash);
  // Back on the branch: its programs start once more.
  run->execute("rewind", 2, "");
  advance_to(*run, steps - 400, 2);
  EXPECT_TRUE(run->control().paused);
  run->execute("resume", 0, "");
  advance_to(*run, steps, 2);
  EXPECT_EQ(run->world().state().hash(), recorded.state_hash);
}

TEST_F(RelaunchedRun, TheProgramsOfABranchActOnWhatItChanges) {
  const auto run = run_again(true);
  advance_to(*run, 250, 0);
  run->execute("pause", 0, "");
  run->execute("branch", 0, "");
  advance_to(*run, 250, 1);
  const std::string push =
      "{publish: {channel: segway1.balance.cmd, type: shoal.twist_command_t, value: {forward_mps: 0.5}}}";
  run->execute("do", 0, push);
  run->execute("resume", 0, "");
  advance_to(*run, steps, 1);
  EXPECT_NE(run->world().state().hash(), recorded.state_hash);
  EXPECT_GT(run->world().vehicles().front()->X_WV().translation().x(), 0.2) << "its program drives forward";
}

TEST_F(RelaunchedRun, ABranchWithRecordedCommandsEndsAsTheRunDid) {
  const auto run = run_again(true);
  advance_to(*run, 250, 0);
  EXPECT_THAT(run->execute("branch", 0, "recorded"), HasSubstr("programs: recorded commands"));
  advance_to(*run, steps, 1);
  EXPECT_EQ(run->world().state().hash(), recorded.state_hash);
}

TEST_F(RelaunchedRun, StartsNoProgramUnlessTheCommandLineSaysSo) {
  const auto run = run_again(false);
  advance_to(*run, 250, 0);
  EXPECT_TRUE(run->commands().empty());
  EXPECT_THROW(run->execute("branch", 0, "restarted"), std::runtime_error);
  EXPECT_THAT(run->execute("branch", 0, ""), HasSubstr("programs: recorded commands"));
}

TEST_F(RelaunchedRun, ItsScoresAreThoseOfTheRun) {
  const auto run = run_again(false);
  advance_to(*run, 400, 0);
  const auto half = texts_of(run->scoring().figures());
  advance_to(*run, steps, 0);
  EXPECT_EQ(texts_of(run->scoring().figures()), texts_of(recorded.metrics));
  ASSERT_FALSE(run->scoring().verdicts().empty());
  // Taken back, they are those of that time again.
  run->execute("rewind", 2, "");
  advance_to(*run, 400, 0);
  run->advance();
  EXPECT_EQ(texts_of(run->scoring().figures()), half);
  EXPECT_NE(half, texts_of(recorded.metrics));
}

}  // namespace
