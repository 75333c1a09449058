// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/runner.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "experiment/results/results_folder.hpp"
#include "tests/experiment/results/quiet_runs.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::HasSubstr;

TEST(RunWorld, RunsAWorldToItsEnd) {
  const experiment::Summary summary = experiment::run_world(quiet_runs::small_world(), quiet_runs::quiet_run());
  EXPECT_EQ(summary.exit_code, 0) << summary.error;
  EXPECT_EQ(summary.world, "small");
  EXPECT_EQ(summary.seed, 7);
  EXPECT_DOUBLE_EQ(summary.sim_time_s, 0.5);
}

TEST(RunWorld, ProgramsNeedABusToBeStarted) {
  experiment::RunOptions options = quiet_runs::quiet_run();
  options.launch = true;
  const experiment::Summary summary = experiment::run_world(quiet_runs::small_world(), options);
  EXPECT_EQ(summary.exit_code, 2);
  EXPECT_EQ(summary.ended, "configuration");
  EXPECT_THAT(summary.error, HasSubstr("--launch needs the LCM bus"));
}

TEST(RunWorld, LeavesTheFolderOfAnotherRunAlone) {
  const test_support::ScratchFolder folder;
  experiment::RunOptions options = quiet_runs::quiet_run();
  options.results = folder.file("results");
  const experiment::ResultsLock lock(options.results);
  EXPECT_EQ(experiment::run_world(quiet_runs::small_world(), options).exit_code, 4);
  EXPECT_FALSE(std::filesystem::exists(options.results + "/summary.json"));
}

TEST(BugHint, NamesTheCommandThatReportsARun) {
  EXPECT_EQ(experiment::bug_hint("results/a", "a.lcm"), "to report this: shoal bug results/a --record a.lcm");
  EXPECT_EQ(experiment::bug_hint("results/a", ""), "to report this: shoal bug results/a");
  EXPECT_THAT(experiment::bug_hint("", ""), HasSubstr("run it again with --results DIR --record FILE"));
}

}  // namespace
