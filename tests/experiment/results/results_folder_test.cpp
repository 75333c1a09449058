// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/results_folder.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "experiment/results/results.hpp"
#include "experiment/results/run_error.hpp"
#include "experiment/run/runner.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/config/config_node.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/experiment/results/quiet_runs.hpp"
#include "tests/scratch_folder.hpp"

namespace {

std::string error_of(const std::string& folder) {
  try {
    experiment::ResultsLock lock(folder);
  } catch (const experiment::RunError& error) {
    EXPECT_EQ(error.exit_code, 4);
    return error.what();
  }
  return "none";
}

TEST(ResultsLock, MakesTheFolderAndReleasesItAtItsEnd) {
  const test_support::ScratchFolder folder;
  EXPECT_EQ(error_of(folder.file("a/b")), "none");
  EXPECT_TRUE(std::filesystem::is_directory(folder.file("a/b")));
  EXPECT_EQ(error_of(folder.file("a/b")), "none");
}

TEST(ResultsLock, NamesWhoHoldsTheFolder) {
  const test_support::ScratchFolder folder;
  const experiment::ResultsLock lock(folder.file("results"));
  EXPECT_THAT(error_of(folder.file("results")),
              testing::AllOf(testing::HasSubstr(std::to_string(getpid())),
                             testing::EndsWith("is writing there; choose another folder with --results")));
}

TEST(ResultsLock, AFileIsNoFolder) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("results")) << "a file";
  EXPECT_THAT(error_of(folder.file("results")),
              testing::StartsWith("cannot write results to '" + folder.file("results") + "': "));
}

TEST(CannotWriteText, SaysWhatToDo) {
  EXPECT_EQ(experiment::cannot_write_text("out", EROFS),
            "cannot write results to 'out': Read-only file system; choose another folder with --results");
  EXPECT_EQ(experiment::cannot_write_text("out", ENOSPC),
            "cannot write results to 'out': No space left on device; free some space, or choose another folder with "
            "--results");
  EXPECT_EQ(experiment::cannot_write_text("out", EIO), "cannot write results to 'out': Input/output error");
}

using namespace quiet_runs;

namespace fs = std::filesystem;

using lcm_test::ScratchFolder;

TEST(Results, ReplaceThoseOfAnEarlierRun) {
  const ScratchFolder folder;
  const auto loaded = small_world();
  auto options = quiet_run();
  options.results = folder.file("results");
  EXPECT_EQ(experiment::run_world(loaded, options).exit_code, 0);
  options.launch = true;
  EXPECT_EQ(experiment::run_world(loaded, options).exit_code, 2);
  const auto json = nlohmann::json::parse(text_of_file(options.results + "/summary.json"));
  EXPECT_EQ(json["ended"], "configuration");
  EXPECT_EQ(json["steps"], 0);
  for (const char* file : {"metrics.csv", "errors.csv", "tracks.csv", "tracks.png"})
    EXPECT_FALSE(fs::exists(options.results + "/" + file)) << file;
}

TEST(Results, AreNeverMixedWithThoseOfAnotherWorld) {
  const ScratchFolder folder;
  auto options = quiet_run();
  options.results = folder.file("results");
  const auto path = [&](const std::string& file) { return options.results + "/" + file; };
  experiment::run_world(small_world("processes: [{name: guest, command: [guest]}, {name: guide, command: [guide]}]\n"),
                        options);
  fs::create_directory(path("branch0"));
  fs::create_directory(path("branch1"));
  for (const char* file : {"guest.log", "guide.log", "report.html", "run.html", "branch0/summary.json",
                           "branch1/tracks.csv", "branch1/mine.txt", "mine.log", "mine.lcm", "branching.txt"})
    std::ofstream(path(file)) << "of the earlier run\n";
  experiment::run_world(small_world(), options);
  for (const char* file : {"guest.log", "guide.log", "report.html", "run.html", "branch0", "branch1/tracks.csv"})
    EXPECT_FALSE(fs::exists(path(file))) << file;
  // What no run writes by itself is kept.
  for (const char* file : {"branch1/mine.txt", "mine.log", "mine.lcm", "branching.txt"})
    EXPECT_TRUE(fs::exists(path(file))) << file;
  EXPECT_TRUE(fs::exists(path("summary.json")));
  EXPECT_THAT(text_of_file(path("world.yaml")), testing::Not(testing::HasSubstr("guest")));
}

TEST(Results, OfAnEarlierRunAreGoneWhenARunIsKilled) {
  const ScratchFolder folder;
  const auto loaded = small_world();
  auto options = quiet_run();
  options.results = folder.file("results");
  EXPECT_EQ(experiment::run_world(loaded, options).exit_code, 0);
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  experiment::remove_earlier_run(options.results);
  {
    const experiment::Results killed(options.results, world);
  }  // as far as a run comes that is killed in its first step
  for (const char* file : {"summary.json", "metrics.csv", "errors.csv", "tracks.png"})
    EXPECT_FALSE(fs::exists(options.results + "/" + file)) << file;
  EXPECT_TRUE(fs::exists(options.results + "/world.yaml"));
}

}  // namespace
