// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>
#include <regex>
#include <set>

#include "tests/system/shoal_program.hpp"

namespace {

namespace fs = std::filesystem;

using namespace system_test;
using testing::HasSubstr;
using testing::Not;

/// A study of a rover that stands, planned in the folder `out`; `more`: keys of the study, `world`: keys of the world.
struct CampaignFolder {
  explicit CampaignFolder(const std::string& more, const std::string& world = "") {
    write_file(folder.file("world.yaml"),
               "shoal: 1\nrun: {duration_s: 1}\n"
               "objects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\n"
               "vehicles: [{name: rover1, file: " +
                   source("vehicles/rover.yaml") +
                   "}]\n"
                   "metrics: [{name: distance, type: distance, vehicle: rover1}]\n" +
                   world);
    write_file(folder.file("study.yaml"), "shoal: 1\nstudy: tiny\nworld: world.yaml\n" + more);
  }
  Ended call(const std::string& what, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"study", what};
    if (what == "plan") arguments.insert(arguments.end(), {folder.file("study.yaml"), "--output"});
    arguments.push_back(out());
    if (what == "study") arguments = {"study", folder.file("study.yaml"), "--output", out()};
    arguments.insert(arguments.end(), {"--allow-path", folder.file("")});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_shoal(arguments);
  }
  std::string out() const { return folder.file("out"); }
  std::string text(const std::string& file) const { return text_of_file(folder.file("out/" + file)); }
  /// study.csv without the wall times.
  std::string table() const {
    return std::regex_replace(text("study.csv"), std::regex(R"(,(\d+\.\d{3}),([0-9a-f]{16}),)"), ",,$2,");
  }

  ScratchFolder folder;
};

const std::string six_runs =
    "seeds: [1, 2]\nfactors: [{name: g, paths: [physics.gravity_mps2], from: 1, to: 9, levels: 3}]\n";

TEST(Campaign, PlanRunAndCollectGiveTheTableOfAStudy) {
  const CampaignFolder steps(six_runs), whole(six_runs);
  const Ended plan = steps.call("plan");
  EXPECT_EQ(plan.exit_code, 0) << plan.errors;
  EXPECT_THAT(plan.output, HasSubstr("manifest.jsonl: 6 runs: 1 cases, 3 points, 2 seeds\n"));
  EXPECT_EQ(steps.call("run", {"--index", "4-6"}).exit_code, 0);
  const Ended early = steps.call("collect");
  EXPECT_EQ(early.exit_code, 4);
  EXPECT_THAT(early.output,
              HasSubstr("3 runs have no result\n  run 1, seed 1: it has not been run\n    shoal study run " +
                        steps.out() + " --index 1\n    shoal run "));
  const Ended rest = steps.call("run", {"--jobs", "2"});
  EXPECT_EQ(rest.exit_code, 0) << rest.errors;
  EXPECT_THAT(rest.errors, HasSubstr("3 of 6 runs were already done"));
  const Ended collected = steps.call("collect");
  EXPECT_EQ(collected.exit_code, 0) << collected.errors;
  EXPECT_EQ(whole.call("study").exit_code, 0);
  EXPECT_EQ(steps.table(), whole.table());
  EXPECT_THAT(steps.table(), HasSubstr("distance.travelled_m,run,point,g,shoal,processor,c_library\n"));
  EXPECT_THAT(steps.table(),
              testing::ContainsRegex("\nworld,2,0,,duration,1,,[0-9a-f]+,[^,]+,6,3,9,[^,]+,[^,]+,glibc"));
  EXPECT_THAT(steps.text("points.csv"), HasSubstr("\nworld,3,9,distance.travelled_m,2,2,"));
  EXPECT_THAT(steps.text("study.sqlite"), testing::StartsWith("SQLite format 3"));
  EXPECT_THAT(steps.text("report.html"), HasSubstr("tiny"));
  EXPECT_THAT(collected.output, HasSubstr("differences in pairs of equal seeds"));
}

TEST(Campaign, CommandsReportWrongUse) {
  const CampaignFolder study(six_runs);
  const Ended none = study.call("run");
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_THAT(none.errors,
              HasSubstr("manifest.jsonl: there is no manifest; `shoal study plan STUDY --output DIR` writes one"));
  ASSERT_EQ(study.call("plan").exit_code, 0);
  const Ended far = study.call("run", {"--index", "7"});
  EXPECT_EQ(far.exit_code, 2);
  EXPECT_THAT(far.errors, HasSubstr("--index: must be numbers of runs from 1 to 6, or ranges such as 1-10, got '7'"));
  const Ended alone = run_shoal({"study"});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_THAT(alone.errors, HasSubstr("STUDY is required, or a command: plan, run or collect"));
}

TEST(Campaign, ContinuesAfterItsRunnerIsKilled) {
  const CampaignFolder study("seeds: 1-40\nduration_s: 20\n"), whole("seeds: 1-40\nduration_s: 20\n");
  ASSERT_EQ(study.call("plan").exit_code, 0);
  const std::string runs = study.out() + "/runs/world";
  const auto finished = [&] {
    std::size_t count = 0;
    for (int seed = 1; seed <= 40; ++seed)
      count += fs::exists(runs + "/seed_" + std::to_string(seed) + "/study_stamp.txt");
    return count;
  };
  {
    Program runner({built("shoal"), "study", "run", study.out(), "--jobs", "2", "--allow-path", study.folder.file("")});
    ASSERT_TRUE(await([&] { return finished() >= 3; }, timeout)) << runner.errors();
    runner.send_signal(SIGKILL);
    EXPECT_EQ(runner.wait(), 128 + SIGKILL);
  }
  const std::size_t before = finished();
  ASSERT_LT(before, 40u);
  // A file that was being written.
  fs::create_directories(runs + "/seed_40");
  write_file(runs + "/seed_40/study_stamp.txt", "inputs 0123");
  const Ended ended = study.call("run", {"--jobs", "2"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.errors, HasSubstr(std::to_string(before) + " of 40 runs were already done"));
  EXPECT_EQ(study.call("collect").exit_code, 0);
  EXPECT_EQ(whole.call("study", {"--jobs", "2"}).exit_code, 0);
  EXPECT_EQ(study.table(), whole.table());
}

TEST(Campaign, TwoRunnersShareTheRuns) {
  const CampaignFolder study("seeds: 1-12\nduration_s: 30\n");
  ASSERT_EQ(study.call("plan").exit_code, 0);
  const std::vector<std::string> command{built("shoal"), "study", "run",          study.out(),
                                         "--jobs",       "1",     "--allow-path", study.folder.file("")};
  Program first(command), second(command);
  EXPECT_EQ(first.wait(), 0) << first.errors();
  EXPECT_EQ(second.wait(), 0) << second.errors();
  EXPECT_EQ(study.call("collect").exit_code, 0);
  // Each run was executed once: reports of finished runs add up.
  const std::string all = first.errors() + second.errors();
  const std::regex done("\\[\\d+/12\\] world, seed (\\d+): done");
  std::multiset<std::string> seeds;
  for (std::sregex_iterator at(all.begin(), all.end(), done), end; at != end; ++at) seeds.insert((*at)[1]);
  EXPECT_EQ(seeds.size(), 12u) << all;
  EXPECT_EQ(std::set<std::string>(seeds.begin(), seeds.end()).size(), 12u);
}

TEST(Campaign, ListsFailedRunsWithTheCommandThatRepeatsThem) {
  const CampaignFolder study(
      "seeds: [1]\nlaunch: true\ncases: [{name: good}, {name: bad, set: {processes: [{name: ghost, "
      "command: [no-such-program]}]}}]\n");
  ASSERT_EQ(study.call("plan").exit_code, 0);
  const Ended run = study.call("run");
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_THAT(run.errors, HasSubstr("1 runs failed; `shoal study collect "));
  const Ended collected = study.call("collect");
  EXPECT_EQ(collected.exit_code, 4);
  EXPECT_THAT(collected.output,
              testing::ContainsRegex("  run 2, seed 1: .*no-such-program.*\n    shoal study run .*/out "
                                     "--index 2\n    shoal run .*/world.yaml --seed 1 --set "));
  EXPECT_THAT(study.text("study.json"), HasSubstr("\"repeat\": \"shoal run "));
}

TEST(Campaign, ARunThatTakesTooLongHasFailed) {
  const CampaignFolder study("seeds: [1]\nduration_s: 1e9\n");
  ASSERT_EQ(study.call("plan").exit_code, 0);
  EXPECT_EQ(study.call("run", {"--run-timeout", "0.3"}).exit_code, 4);
  EXPECT_THAT(study.call("collect").output, HasSubstr("run 1, seed 1: took longer than 0.3 s"));
}

TEST(Campaign, StopsWhenTheResultIsCertain) {
  // All runs travel the same way, so that the interval is 0 after the first batch.
  const std::string until =
      "seeds: 1-30\nbatch: 4\nuntil: ci(distance.travelled_m) < 0.1\nfigures: [distance.travelled_m]\n";
  const CampaignFolder study(until), steps(until);
  const Ended ended = study.call("study", {"--jobs", "2"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("study tiny: 4 runs"));
  EXPECT_THAT(ended.output, HasSubstr("certain after 4 of 30 seeds: ci(distance.travelled_m) is below its bound"));
  EXPECT_FALSE(fs::exists(study.out() + "/runs/world/seed_5"));
  // Further runs do not change the result.
  ASSERT_EQ(steps.call("plan").exit_code, 0);
  EXPECT_EQ(steps.call("run", {"--index", "1-9"}).exit_code, 0);
  EXPECT_EQ(steps.call("collect").exit_code, 0);
  EXPECT_EQ(steps.table(), study.table());
}

TEST(Campaign, WarnsOfRunsOfDifferentProcessors) {
  const CampaignFolder study("seeds: [1, 2]\n");
  ASSERT_EQ(study.call("study").exit_code, 0);
  const std::string file = study.out() + "/runs/world/seed_2/summary.json";
  std::string text = text_of_file(file);
  text = std::regex_replace(text, std::regex("\"build\": \"[^\"]*\""), "\"build\": \"vax, glibc 1.0\"");
  write_file(file, text);
  const Ended collected = study.call("collect");
  EXPECT_EQ(collected.exit_code, 0);
  EXPECT_THAT(collected.output,
              HasSubstr("note: the runs are of different programs or machines, so that their last bits "
                        "may differ: 1 of shoal "));
  EXPECT_THAT(collected.output, HasSubstr("vax, glibc 1.0"));
  EXPECT_THAT(study.table(), HasSubstr(",vax,glibc 1.0\n"));
}

TEST(Campaign, TheEngineParallelGivesTheSameTable) {
  if (std::system("parallel --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "GNU parallel is not installed";
  const CampaignFolder study(six_runs), whole(six_runs);
  ASSERT_EQ(study.call("plan").exit_code, 0);
  const Ended run = study.call("run", {"--engine", "parallel", "--jobs", "2", "--quiet"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(study.call("collect").exit_code, 0);
  EXPECT_EQ(whole.call("study").exit_code, 0);
  EXPECT_EQ(study.table(), whole.table());
  EXPECT_THAT(study.text("parallel.log"), HasSubstr("Exitval"));
}

TEST(Campaign, GnuParallelGetsNoNameThatItWouldExecute) {
  if (std::system("parallel --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "GNU parallel is not installed";
  const CampaignFolder study(six_runs);
  ASSERT_EQ(study.call("plan").exit_code, 0);
  const std::string hostile = study.folder.file("par{=exit 3=}");
  std::filesystem::create_directory(hostile);
  const Ended run = study.call("run", {"--engine", "parallel", "--quiet", "--allow-path", hostile});
  EXPECT_NE(run.exit_code, 0);
  EXPECT_THAT(run.errors, HasSubstr("must not have a '{' with the engine parallel"));
}

TEST(Campaign, AnEmptyListOfRunsIsNotAllRuns) {
  const CampaignFolder study(six_runs);
  ASSERT_EQ(study.call("plan").exit_code, 0);
  const Ended run = study.call("run", {"--index", ""});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.errors, HasSubstr("--index"));
}

TEST(Campaign, ALinkInPlaceOfALogIsNotFollowed) {
  const CampaignFolder study("seeds: [1]\n");
  ASSERT_EQ(study.call("plan").exit_code, 0);
  ASSERT_EQ(study.call("run").exit_code, 0);
  std::string log;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(study.out()))
    if (entry.path().filename() == "run.log") log = entry.path();
  ASSERT_NE(log, "");
  write_file(study.folder.file("victim"), "mine");
  std::filesystem::remove(log);
  std::filesystem::create_symlink(study.folder.file("victim"), log);
  EXPECT_NE(study.call("run", {"--fresh"}).exit_code, 0);
  EXPECT_EQ(text_of_file(study.folder.file("victim")), "mine");
}

TEST(Campaign, ItsPageHasCurvesAndTheRunsToLookAt) {
  const CampaignFolder study(
      "seeds: 1-3\nfactors: [{name: g, paths: [physics.gravity_mps2], from: 1, to: 9, levels: 3}]\n");
  ASSERT_EQ(study.call("study").exit_code, 0);
  const std::string page = study.text("report.html");
  EXPECT_THAT(page, HasSubstr("<title>distance.travelled_m over g</title>"));
  EXPECT_THAT(page, HasSubstr("<title>distance.travelled_m over the number of seeds</title>"));
  EXPECT_THAT(page, HasSubstr("<h2>Runs to look at</h2>"));
  EXPECT_THAT(page, HasSubstr("<a href=\"runs/world/point_1/seed_1/summary.json\">summary</a>"));
  EXPECT_THAT(page, HasSubstr("<td>point 2 - point 1</td>"));
}

TEST(Campaign, ShowsTheExtremeRunsInThreeDimensions) {
  const CampaignFolder study("seeds: [1]\nfactors: [{name: g, paths: [physics.gravity_mps2], values: [1, 5, 9]}]\n");
  ASSERT_EQ(study.call("study").exit_code, 0);
  EXPECT_EQ(study.call("collect", {"--show"}).exit_code, 0);
  EXPECT_THAT(study.text("report.html"), HasSubstr("<a href=\"shown/run_1/run.html\">view</a>"));
  EXPECT_THAT(study.text("report.html"), HasSubstr("<a href=\"shown/run_3/run.html\">view</a>"));
  EXPECT_FALSE(fs::exists(study.out() + "/shown/run_2"));
  const std::string world = study.out() + "/runs/world/point_3/seed_1", shown = study.out() + "/shown/run_3";
  EXPECT_EQ(summary_value(shown, "run_hash"), summary_value(world, "run_hash"));
}

TEST(Campaign, TuningFindsTheBestEndOfARangeAndContinues) {
  // A ball falls for a second: the distance is g / 2, and the smallest at the lower end of the range.
  const ScratchFolder folder;
  write_file(folder.file("world.yaml"),
             "shoal: 1\nrun: {duration_s: 1}\nvehicles:\n  - name: m\n    position_m: [0, 0, 20]\n    model:\n"
             "      shoal: 1\n      vehicle: ball\n      bodies: [{name: hull, parts: [{shape: sphere, "
             "radius_m: 0.1, mass_kg: 1}]}]\nmetrics: [{name: distance, type: distance, vehicle: m}]\n");
  write_file(folder.file("study.yaml"),
             "shoal: 1\nstudy: fall\nworld: world.yaml\nseeds: [1]\n"
             "factors: [{name: g, paths: [physics.gravity_mps2], from: 1, to: 9}]\n");
  const auto tune = [&](const std::string& goal) {
    return run_shoal({"tune", folder.file("study.yaml"), "--figure", "distance.travelled_m", "--goal", goal,
                      "--generations", "8", "--output", folder.file("out"), "--jobs", "2"});
  };
  const Ended first = tune("min");
  EXPECT_EQ(first.exit_code, 0) << first.errors;
  std::smatch best;
  ASSERT_TRUE(std::regex_search(first.output, best, std::regex("best of 32 points: g = ([0-9.]+)\nshoal run ")))
      << first.output;
  EXPECT_LT(std::stod(best[1]), 1.2);
  const Ended second = tune("min");
  EXPECT_EQ(second.output, first.output);
  EXPECT_THAT(second.errors, Not(HasSubstr("done, not judged")));
  // A figure that the world does not have.
  EXPECT_THAT(run_shoal({"tune", folder.file("study.yaml"), "--figure", "distance.travelled"}).errors,
              HasSubstr("--figure: metric 'distance' has no figure 'travelled'"));
}

TEST(Campaign, ReportsThatAnEngineIsNotInstalled) {
  const CampaignFolder study("seeds: [1]\n");
  ASSERT_EQ(study.call("plan").exit_code, 0);
  const ScratchFolder nothing;
  Program program({"/usr/bin/env", "PATH=" + nothing.file(""), built("shoal"), "study", "run", study.out(), "--engine",
                   "slurm", "--allow-path", study.folder.file("")});
  EXPECT_EQ(program.wait(), 4);
  EXPECT_THAT(program.errors(),
              HasSubstr("there is no program 'sbatch' in PATH; Debian has it in the package slurm-client"));
}

}  // namespace
