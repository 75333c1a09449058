// SPDX-License-Identifier: BSD-3-Clause
// Runs that meet a full disk, another run, a pipe, a step that does not end, or physics that nearly stands still.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/system/shoal_program.hpp"

namespace {

using namespace system_test;
using testing::HasSubstr;
using testing::Not;

const char* const endless =
    "shoal: 1\nrun: {duration_s: forever, speed: 1}\nobjects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\n";

/// Cubes of 0.5 m, all within the same cubic meter: nearly all of them overlap.
std::string heap_of(int boxes) {
  std::string world = "shoal: 1\nrun: {duration_s: 1, speed: max}\nobjects:\n";
  for (int i = 0; i < boxes; ++i) {
    const auto at = [&](int step) { return std::to_string(0.001 * (i * step % 1000)); };
    world += "  - {name: box" + std::to_string(i) + ", position_m: [" + at(37) + ", " + at(101) + ", " + at(211) +
             "], parts: [{shape: box, size_m: [0.5, 0.5, 0.5], mass_kg: 1}]}\n";
  }
  return world;
}

/// Runs a command in its own name space, where `folder` is a disk of so many bytes.
std::vector<std::string> on_small_disk(const std::string& folder, int bytes, const std::string& command) {
  return {"unshare", "-rm", "sh", "-c",
          "mount -t tmpfs -o size=" + std::to_string(bytes) + " none " + folder + " || exit; " + command};
}

bool can_mount() {
  const ScratchFolder folder;
  return Program(on_small_disk(folder.file(""), 1 << 20, "true")).wait() == 0;
}

TEST(FullDisk, LosesNeitherScoreNorHash) {
  if (!can_mount()) GTEST_SKIP() << "mounts in a name space are not permitted here";
  const ScratchFolder folder;
  const std::string disk = folder.file("disk");
  std::filesystem::create_directory(disk);
  const std::string run = built("shoal") + " run " + source("worlds/minimal.yaml") +
                          " --duration 300 --bus none --speed max --no-plots --quiet";
  Program reference({"sh", "-c", run + " --results " + folder.file("reference")});
  ASSERT_EQ(reference.wait(), 0) << reference.errors();
  const auto expected = nlohmann::json::parse(text_of_file(folder.file("reference") + "/summary.json"));
  // The rest of the disk is filled when the run has begun: tracks.csv is there.  The run stands still meanwhile.
  Program program(on_small_disk(disk, 3 << 20,
                                run + " --results " + disk + "/r & run=$!; while [ ! -s " + disk +
                                    "/r/outlines.dat ]; do sleep 0.01; done; kill -STOP $run; cat /dev/zero > " + disk +
                                    "/filler 2>/dev/null; kill -CONT $run; wait $run; code=$?; cp " + disk +
                                    "/r/summary.json " + folder.file("saved.json") + "; exit $code"));
  const int code = program.wait();
  EXPECT_TRUE(code == 4 || code == 0) << code;  // it may have been over before it was stopped
  const auto saved = nlohmann::json::parse(text_of_file(folder.file("saved.json")));
  EXPECT_EQ(saved["exit_code"], code);
  EXPECT_EQ(saved["run_hash"].get<std::string>().size(), 16u);
  if (saved["steps"] == expected["steps"]) {
    EXPECT_EQ(saved["run_hash"], expected["run_hash"]);
  }
  if (code == 4) {
    EXPECT_THAT(program.errors(), HasSubstr("No space left on device"));
  }
}

TEST(FullDisk, PrintsTheSummaryThatCannotBeSaved) {
  const ScratchFolder folder;
  const std::string results = folder.file("results");
  std::filesystem::create_directories(results + "/summary.json/in_the_way");
  Program program({built("shoal"), "run", source("worlds/minimal.yaml"), "--duration", "1", "--bus", "none", "--speed",
                   "max", "--no-plots", "--quiet", "--results", results});
  EXPECT_EQ(program.wait(), 4);
  EXPECT_THAT(program.errors(), HasSubstr("summary.json"));
  EXPECT_THAT(program.output(), HasSubstr("run hash"));
}

/// A stranger's folder may come with results in it.
TEST(Results, AreNotWrittenThroughLinks) {
  const ScratchFolder folder;
  write_file(folder.file("world.yaml"), "shoal: 1\nrun: {duration_s: 0.1, speed: max}\n");
  write_file(folder.file("profile"), "mine");
  std::filesystem::create_directory(folder.file("results"));
  const std::vector<std::string> names = {"world.yaml",   "tracks.csv",        "errors.csv",        "metrics.csv",
                                          "summary.json", "summary.json.part", "summary.json.part2"};
  for (const std::string& name : names)
    std::filesystem::create_symlink(folder.file("profile"), folder.file("results") + "/" + name);
  const Ended ended =
      run_shoal({"run", folder.file("world.yaml"), "--bus", "none", "--results", folder.file("results")});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_EQ(text_of_file(folder.file("profile")), "mine");
  EXPECT_THAT(text_of_file(folder.file("results") + "/summary.json"), HasSubstr("\"steps\""));
}

TEST(Snapshots, AreNotWrittenThroughALinkInTheResults) {
  const ScratchFolder folder;
  write_file(folder.file("world.yaml"), "shoal: 1\nrun: {duration_s: 0.1, speed: max}\n");
  for (const char* name : {"results", "home"}) std::filesystem::create_directory(folder.file(name));
  std::filesystem::create_directory_symlink(folder.file("home"), folder.file("results") + "/snapshots");
  const Ended ended = run_shoal({"run", folder.file("world.yaml"), "--bus", "none", "--results", folder.file("results"),
                                 "--snapshot-at", "0.05"});
  EXPECT_EQ(ended.exit_code, 4);
  EXPECT_THAT(ended.errors, HasSubstr("/results/snapshots: is a symbolic link, through which nothing is written"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.file("home")));
}

TEST(Snapshots, OfAnEarlierRunAreAnErrorBeforeTheRun) {
  const ScratchFolder folder;
  write_file(folder.file("world.yaml"), "shoal: 1\nrun: {duration_s: 2, speed: max}\n");
  const std::vector<std::string> run = {
      "run", folder.file("world.yaml"), "--bus", "none", "--snapshots", folder.file("snaps"), "--snapshot-every",
      "0.7"};
  EXPECT_EQ(run_shoal(run).exit_code, 0);
  const Ended again = run_shoal(run);
  EXPECT_EQ(again.exit_code, 4);
  EXPECT_THAT(again.errors, HasSubstr("branch0_step70.snapshot: a snapshot of an earlier run"));
  EXPECT_THAT(again.output, Not(HasSubstr("run hash")));
  std::vector<std::string> replaced = run;
  replaced.push_back("--overwrite");
  EXPECT_EQ(run_shoal(replaced).exit_code, 0);
}

TEST(SpecialFiles, AreRefusedAsLogsToo) {
  const ScratchFolder folder;
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  const Ended ended = run_shoal({"replay", folder.file("pipe")});
  EXPECT_NE(ended.exit_code, 0);
  EXPECT_THAT(ended.errors, HasSubstr("pipe: is not a regular file"));
}

TEST(TwoRuns, CannotShareAResultsFolder) {
  const ScratchFolder folder;
  write_file(folder.file("world.yaml"), endless);
  const std::vector<std::string> run = {built("shoal"), "run",       folder.file("world.yaml"), "--bus",
                                        "none",         "--results", folder.file("results")};
  Program first(run);
  ASSERT_TRUE(await([&] { return std::filesystem::exists(folder.file("results") + "/tracks.csv"); }));
  Program second(run);
  EXPECT_EQ(second.wait(), 4);
  EXPECT_THAT(second.errors(), HasSubstr("cannot write results to '" + folder.file("results") + "': process " +
                                         std::to_string(first.pid())));
  EXPECT_THAT(second.errors(), HasSubstr("is writing there"));
  first.send_signal(SIGKILL);
  first.wait();
  std::filesystem::remove(folder.file("results") + "/world.yaml");
  Program third(run);  // a dead run is not an owner
  ASSERT_TRUE(await([&] { return std::filesystem::exists(folder.file("results") + "/world.yaml"); }, timeout));
  third.send_signal(SIGTERM);
  EXPECT_EQ(third.wait(), 128 + SIGTERM) << third.errors();
  EXPECT_TRUE(std::filesystem::exists(folder.file("results") + "/summary.json"));
}

TEST(TwoRuns, CannotShareARecord) {
  const ScratchFolder folder;
  write_file(folder.file("world.yaml"), endless);
  const std::vector<std::string> run = {built("shoal"), "run",      folder.file("world.yaml"), "--bus",
                                        "none",         "--record", folder.file("run.lcm"),    "--overwrite"};
  Program first(run);
  const auto recorded = [&] {
    std::error_code error;
    const auto size = std::filesystem::file_size(folder.file("run.lcm"), error);
    return !error && size > 0;
  };
  ASSERT_TRUE(await(recorded));
  Program second(run);
  EXPECT_EQ(second.wait(), 4);
  EXPECT_THAT(second.errors(), HasSubstr("run.lcm: process " + std::to_string(first.pid())));
  EXPECT_TRUE(recorded());
  first.send_signal(SIGTERM);
  EXPECT_EQ(first.wait(), 128 + SIGTERM);
}

TEST(SpecialFiles, AreRefusedUnlessAskedFor) {
  const ScratchFolder folder;
  const std::string pipe = folder.file("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  Program world({built("shoal"), "run", pipe, "--bus", "none"});
  EXPECT_EQ(world.wait(), 2);
  EXPECT_THAT(world.errors(), HasSubstr("it is not a regular file; 'shoal run --special-files' allows that"));
  Program check({built("shoal"), "check", pipe});
  EXPECT_EQ(check.wait(), 2);
  const std::string minimal = source("worlds/minimal.yaml");
  for (const std::string& record : {pipe, std::string("/dev/null"), folder.file("")}) {
    Program program(
        {built("shoal"), "run", minimal, "--bus", "none", "--duration", "1", "--record", record, "--overwrite"});
    EXPECT_EQ(program.wait(), 4) << record;
    EXPECT_THAT(program.errors(), HasSubstr(record + ": cannot record: it is"));
  }
  Program requested({"sh", "-c",
                     "printf 'shoal: 1\\n' | " + built("shoal") +
                         " run /dev/stdin --special-files --bus none --duration 1 --speed max --record "
                         "/dev/null --overwrite"});
  EXPECT_EQ(requested.wait(), 0) << requested.errors();
}

double cpu_s(pid_t process) {
  const std::string stat = text_of_file("/proc/" + std::to_string(process) + "/stat");
  std::istringstream in(stat.substr(stat.rfind(')') + 1));
  std::string word;
  for (int i = 0; i < 11; ++i) in >> word;  // up to the fields before utime
  double ticks = 0;
  in >> ticks;
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// The first signal is looked at when the step is over, and that takes a minute of processor time.
TEST(Signals, ASecondOneEndsAStepThatDoesNotEnd) {
  const ScratchFolder folder;
  write_file(folder.file("heap.yaml"), heap_of(200));
  Program shoal({built("shoal"), "run", folder.file("heap.yaml"), "--bus", "none", "--set", "physics.solver=quick",
                 "--set", "physics.quick_iterations=10000", "--log-level", "error", "--results",
                 folder.file("results")});
  ASSERT_TRUE(await([&] { return std::filesystem::exists(folder.file("results") + "/world.yaml"); }, timeout));
  const double begun_s = cpu_s(shoal.pid());
  ASSERT_TRUE(await([&] { return cpu_s(shoal.pid()) > begun_s + 1; }, 3 * timeout));
  int sent = 0;
  EXPECT_TRUE(await(
      [&] {
        if (!shoal.running()) return true;
        shoal.send_signal(SIGTERM);
        ++sent;
        return false;
      },
      timeout));
  EXPECT_GT(sent, 1);
  EXPECT_EQ(shoal.wait(), 128 + SIGTERM);
  EXPECT_THAT(shoal.errors(), HasSubstr("ended by another signal"));
}

TEST(SlowPhysics, IsReportedWithTheBodiesThatCauseIt) {
  const ScratchFolder folder;
  write_file(folder.file("heap.yaml"), heap_of(200));
  // A step at the default 20 iterations takes near the 50 ms that are reported; these take far more on any machine.
  Program shoal({built("shoal"), "run", folder.file("heap.yaml"), "--bus", "none", "--duration", "0.03", "--set",
                 "physics.quick_iterations=60"});
  EXPECT_EQ(shoal.wait(), 0);
  EXPECT_THAT(shoal.errors(), HasSubstr("times as long as it simulates: 200 bodies touch or are joined"));
  EXPECT_THAT(shoal.errors(), HasSubstr("'box0/body', 'box1/body', 'box2/body', ..."));
}

TEST(SlowPhysics, EndsARunWithItsResultWhenThereIsALimit) {
  const ScratchFolder folder;
  write_file(folder.file("heap.yaml"), heap_of(200) + "limits: {step_cpu_s: 0.005}\n");
  Program shoal(
      {built("shoal"), "run", folder.file("heap.yaml"), "--bus", "none", "--results", folder.file("results")});
  EXPECT_EQ(shoal.wait(), 5);
  EXPECT_THAT(shoal.errors(), HasSubstr("more than 'limits: step_cpu_s' 0.005 allows: 200 bodies"));
  const auto summary = nlohmann::json::parse(text_of_file(folder.file("results") + "/summary.json"));
  EXPECT_EQ(summary["ended"], "limit");
  EXPECT_EQ(summary["exit_code"], 5);
  EXPECT_GE(summary["steps"], 1);
  EXPECT_EQ(summary["passed"], false);
}

TEST(Check, TakesLittleMemoryForEachFurtherVehicleOfAKind) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep memory of their own for each allocation";
#endif
  const auto peak_kB = [](int vehicles) {
    const ScratchFolder folder;
    std::string world = "shoal: 1\nvehicles:\n";
    for (int i = 0; i < vehicles; ++i)
      world += "  - {name: r" + std::to_string(i) + ", file: pioneer.yaml, position_m: [" +
               std::to_string(2 * (i % 100)) + ", " + std::to_string(2 * (i / 100)) + ", 0]}\n";
    write_file(folder.file("world.yaml"), world);
    Program program({built("shoal"), "check", folder.file("world.yaml")});
    EXPECT_EQ(program.wait(), 0) << program.errors();
    EXPECT_THAT(program.output(), HasSubstr(std::to_string(6 * vehicles) + " devices"));
    return static_cast<double>(program.peak_kB());
  };
  const double few = peak_kB(1000), many = peak_kB(4000);
  EXPECT_LT((many - few) / 3000, 21) << "kB for each further Pioneer";
}

}  // namespace
