// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/bug_report/bug_report.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "experiment/run/runner.hpp"
#include "experiment/run/version.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/scratch_folder.hpp"

namespace {

namespace fs = std::filesystem;

using test_support::ScratchFolder;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class BugReportTest : public testing::Test {
 protected:
  /// A run of a second with results and, outside of them, a record.
  BugReportTest() {
    auto loaded = sim::load_world_text(test::rover_world("        - {name: lidar, type: lidar}\n", "", "",
                                                         "run: {duration_s: 1, seed: 7}\n"
                                                         "metrics: [{name: distance, type: distance, vehicle: r1}]\n"),
                                       "small.yaml", test::LoadedTestWorld::with_messages({}));
    loaded.config.name = "small";
    experiment::RunOptions run;
    run.bus = "none";
    run.quiet = true;
    run.plots = false;
    run.results = options.directory = folder.file("run");
    run.record = record = folder.file("run.lcm");
    EXPECT_EQ(experiment::run_world(loaded, run).exit_code, 0);
  }

  /// Packs, and unpacks by `tar` into a folder, whose name is returned.
  std::string packed() {
    report = experiment::write_bug_report(options);
    const std::string out = folder.file("out");
    fs::create_directories(out);
    EXPECT_EQ(std::system(("tar -xzf " + report.path + " -C " + out).c_str()), 0);
    return out + "/bug-small-seed7/";
  }
  std::string error() const {
    try {
      experiment::write_bug_report(options);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  ScratchFolder folder;
  experiment::BugOptions options;
  experiment::BugReport report;
  std::string record;
};

TEST_F(BugReportTest, IsNotWrittenThroughALink) {
  write(folder.file("profile"), "mine");
  fs::create_symlink(folder.file("profile"), options.directory + "/bug.tar.gz.part");
  packed();
  EXPECT_EQ(text_of(folder.file("profile")), "mine");
  EXPECT_FALSE(fs::is_symlink(report.path));
}

TEST_F(BugReportTest, HoldsWorldSummaryVersionsLogsAndTheEndOfTheRecord) {
  options.record = record;
  write(options.directory + "/pilot.log", "mayday\n");
  const std::string in = packed();
  EXPECT_EQ(report.path, options.directory + "/bug.tar.gz");
  EXPECT_EQ(text_of(in + "summary.json"), text_of(options.directory + "/summary.json"));
  EXPECT_EQ(text_of(in + "world.yaml"), text_of(options.directory + "/world.yaml"));
  EXPECT_EQ(text_of(in + "metrics.csv"), text_of(options.directory + "/metrics.csv"));
  EXPECT_EQ(text_of(in + "logs/pilot.log"), "mayday\n");
  EXPECT_THAT(text_of(in + "versions.txt"),
              AllOf(HasSubstr(experiment::short_version()), HasSubstr("ODE: "), HasSubstr("glibc ")));
  EXPECT_EQ(text_of(in + "record_tail.lcm"), text_of(record));  // all of it: it is shorter than 10 s
  EXPECT_THAT(
      text_of(in + "README.txt"),
      AllOf(HasSubstr("A run of world small, seed 7: ended by duration after 1.000 s"), HasSubstr("record_tail.lcm"),
            HasSubstr("shoal replay record_tail.lcm"), HasSubstr("logs/pilot.log (7 bytes)")));
  EXPECT_THAT(report.left_out, IsEmpty());
}

TEST_F(BugReportTest, WithoutARecordSaysSo) {
  EXPECT_FALSE(fs::exists(packed() + "record_tail.lcm"));
  EXPECT_THAT(report.left_out, Contains(HasSubstr("the folder holds none; name it with --record")));
  fs::copy(record, options.directory + "/a.lcm");
  EXPECT_TRUE(fs::exists(packed() + "record_tail.lcm"));  // the only one in the folder
  fs::copy(record, options.directory + "/b.lcm");
  packed();
  EXPECT_THAT(report.left_out, Contains(HasSubstr("holds several; name one with --record")));
}

TEST_F(BugReportTest, TakesNothingFromOutsideOfTheFolder) {
  write(folder.file("secret"), "do not send me");
  fs::create_symlink(folder.file("secret"), options.directory + "/pilot.log");
  fs::create_symlink(record, options.directory + "/link.lcm");
  fs::remove(options.directory + "/metrics.csv");
  fs::create_symlink(folder.file("secret"), options.directory + "/metrics.csv");
  const std::string in = packed();
  EXPECT_FALSE(fs::exists(in + "logs"));
  EXPECT_FALSE(fs::exists(in + "metrics.csv"));
  EXPECT_FALSE(fs::exists(in + "record_tail.lcm"));
  EXPECT_THAT(report.left_out, Contains("pilot.log: is not a plain file"));
  EXPECT_THAT(report.left_out, Contains("metrics.csv: is not a plain file"));
}

TEST_F(BugReportTest, CopiesSmallFilesOfTheWorldAndHashesOfAll) {
  const std::string small = folder.file("rock.stl"), large = folder.file("hills.asc"),
                    removed = folder.file("gone.stl");
  write(small, "solid rock");
  write(large, std::string((1 << 20) + 1, 'x'));
  write(options.directory + "/world.yaml",
        "objects:\n  - {parts: [{mesh: " + small + "}, {terrain: {file: " + large + "}}, {mesh: " + removed + "}]}\n");
  std::string in = packed();
  const std::string hashes = text_of(in + "files.txt");
  EXPECT_THAT(hashes, AllOf(HasSubstr(" " + small), HasSubstr(" " + large), HasSubstr("---------------- " + removed)));
  std::vector<std::string> copies;
  for (const auto& entry : fs::directory_iterator(in + "files")) copies.push_back(text_of(entry.path().string()));
  EXPECT_THAT(copies, testing::ElementsAre("solid rock"));
  EXPECT_THAT(report.left_out, Contains(AllOf(HasSubstr(large), HasSubstr("its hash is in files.txt"))));
  EXPECT_THAT(report.left_out, Contains(removed + ": cannot be read"));
  fs::remove_all(folder.file("out"));
  options.files = false;
  in = packed();
  EXPECT_FALSE(fs::exists(in + "files"));
  EXPECT_TRUE(fs::exists(in + "files.txt"));
}

TEST_F(BugReportTest, KeepsTheEndOfALongLog) {
  write(options.directory + "/pilot.log", std::string(3 << 20, 'x') + "the end");
  const std::string log = text_of(packed() + "logs/pilot.log");
  EXPECT_EQ(log.size(), std::size_t{1} << 20);
  EXPECT_TRUE(log.ends_with("the end"));
  EXPECT_THAT(report.left_out, Contains(HasSubstr("pilot.log: truncated to its last 1048 kB")));
}

TEST_F(BugReportTest, OfARunThatWasKilledHoldsWhatThereIs) {
  options.record = record;
  fs::remove(options.directory + "/summary.json");
  report = experiment::write_bug_report(options);
  EXPECT_THAT(report.left_out, Contains("summary.json: the run did not write it"));
  EXPECT_THAT(report.inside, Contains(HasSubstr("world.yaml")));
}

TEST_F(BugReportTest, ReportsWhatItCannotUse) {
  const std::string run = options.directory;
  options.record = folder.file("nowhere.lcm");
  EXPECT_THAT(error(), HasSubstr("nowhere.lcm"));
  options.record = run + "/world.yaml";
  EXPECT_THAT(error(), HasSubstr("is not a log of a run"));
  EXPECT_FALSE(fs::exists(run + "/bug.tar.gz"));
  options.record = record;
  std::string summary = text_of(run + "/summary.json");
  summary.replace(summary.find("\"seed\": 7"), 9, "\"seed\": 8");
  write(run + "/summary.json", summary);
  EXPECT_THAT(error(),
              HasSubstr("is of world 'small' with seed 7, but the run in " + run + " is of 'small' with seed 8"));
  options.directory = folder.file("nowhere");
  EXPECT_THAT(error(), HasSubstr("nowhere: no such folder"));
  options.directory = folder.file("empty");
  fs::create_directory(options.directory);
  EXPECT_THAT(error(), HasSubstr("empty: is not a run's results folder: it has no summary.json"));
  write(options.directory + "/study.json", "{}");
  EXPECT_THAT(error(), HasSubstr("is a study; name the folder of one of its runs"));
  options.directory = run;
  options.record.clear();
  options.out = folder.file("no/such/bug.tar.gz");
  EXPECT_THAT(error(), HasSubstr("cannot be written"));
}

}  // namespace
