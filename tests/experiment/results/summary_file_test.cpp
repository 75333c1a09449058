// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/summary_file.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "experiment/results/earlier_run.hpp"
#include "experiment/results/results.hpp"
#include "experiment/run/runner.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/experiment/results/quiet_runs.hpp"

namespace {

using namespace quiet_runs;

namespace fs = std::filesystem;

using lcm_test::ScratchFolder;

TEST(Results, NameWhatCannotBeWritten) {
  const auto loaded = small_world();
  auto options = quiet_run();
  options.results = "/proc/nowhere";
  const experiment::Summary summary = experiment::run_world(loaded, options);
  EXPECT_EQ(summary.exit_code, 4);
  EXPECT_THAT(summary.error, testing::HasSubstr("cannot write results to '/proc/nowhere"));
}

TEST(Results, AFullDiskEndsTheRunAndTheRestIsWritten) {
  const ScratchFolder folder;
  auto loaded = small_world();
  loaded.config.run.duration_s = 20;
  auto options = quiet_run();
  options.results = folder.file("results");
  fs::create_directory(options.results);
  fs::create_symlink("/dev/full", options.results + "/tracks.csv");
  const experiment::Summary summary = experiment::run_world(loaded, options);
  EXPECT_EQ(summary.exit_code, 4);
  EXPECT_EQ(summary.steps, 1000);  // the first look
  EXPECT_THAT(summary.error, testing::HasSubstr("tracks.csv': No space left on device"));
  EXPECT_EQ(text_of_file(options.results + "/summary.json"), summary.to_json());
  EXPECT_THAT(text_of_file(options.results + "/metrics.csv"), testing::StartsWith("metric,value\n"));
  EXPECT_TRUE(fs::exists(options.results + "/world.yaml"));
}

TEST(Results, OneFileThatCannotBeWrittenDoesNotLoseTheOthers) {
  const ScratchFolder folder;
  const auto loaded = small_world();
  auto options = quiet_run();
  options.results = folder.file("results");
  fs::create_directories(options.results + "/metrics.csv");
  const experiment::Summary summary = experiment::run_world(loaded, options);
  EXPECT_EQ(summary.exit_code, 4);
  EXPECT_THAT(summary.error, testing::HasSubstr("metrics.csv"));
  EXPECT_EQ(text_of_file(options.results + "/summary.json"), summary.to_json());
  EXPECT_TRUE(fs::exists(options.results + "/world.yaml"));
  EXPECT_TRUE(fs::exists(options.results + "/tracks.png"));
}

}  // namespace
