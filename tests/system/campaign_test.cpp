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
  const std::regex done("\\[\\d+/12\\] world, seed (\\d+): not judged");
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
  const std::string outcome =
      "until: ci(distance.travelled_m) < 0.1 holds after 4 of 30 seeds; runs of the others are "
      "not used; with fewer than 10 seeds this may be chance";
  EXPECT_THAT(ended.output, HasSubstr("\n" + outcome + "\n"));
  EXPECT_THAT(study.text("report.html"),
              HasSubstr("<p>" + std::regex_replace(outcome, std::regex("<"), "&lt;") + ".</p>"));
  EXPECT_THAT(ended.errors, HasSubstr("'batch' is 4: 'until' may be met by chance after fewer than 10 seeds"));
  EXPECT_FALSE(fs::exists(study.out() + "/runs/world/seed_5"));
  // Further runs do not change the result.
  ASSERT_EQ(steps.call("plan").exit_code, 0);
  EXPECT_EQ(steps.call("run", {"--index", "1-9"}).exit_code, 0);
  EXPECT_EQ(steps.call("collect").exit_code, 0);
  EXPECT_EQ(steps.table(), study.table());
}

TEST(Campaign, CountsItsRunsOverAllBatches) {
  // Runs of a world without rules are not judged, so that the share that passed stays unknown.
  const CampaignFolder study("seeds: 1-6\nbatch: 2\nuntil: ci(passed) < 0.1\n");
  const Ended ended = study.call("study");
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  for (int run = 1; run <= 6; ++run)
    EXPECT_THAT(ended.errors, HasSubstr("[" + std::to_string(run) + "/6] world, seed " + std::to_string(run) + ": "));
  EXPECT_THAT(ended.output, HasSubstr("\nuntil: ci(passed) < 0.1 does not hold after all 6 seeds\n"));
  EXPECT_THAT(study.call("study").errors, HasSubstr("6 of 6 runs were already done"));
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

/// A link in the folder of a study to a file or folder that is not the study's, and the command that meets it.
struct HostileLink {
  std::string name;
  std::vector<std::string> command;
  bool to_folder = false;
};

void expect_not_followed(const HostileLink& link) {
  SCOPED_TRACE(link.name);
  const CampaignFolder study("seeds: [1]\nplots: [{name: far, figure: distance.travelled_m}]\n");
  ASSERT_EQ(study.call("plan").exit_code, 0);
  const std::string victim = study.folder.file("victim"), place = study.out() + "/" + link.name;
  fs::create_directories(victim);
  for (const char* name : {"study_stamp.txt", "summary.json", "1.sh"}) write_file(victim + "/" + name, "mine");
  fs::create_directories(fs::path(place).parent_path());
  fs::remove(place);
  fs::create_symlink(link.to_folder ? victim : victim + "/summary.json", place);
  const Ended ended = study.call(link.command.front(), {link.command.begin() + 1, link.command.end()});
  EXPECT_EQ(ended.exit_code, 4);
  EXPECT_THAT(ended.errors, HasSubstr("/" + link.name + ": is a symbolic link, through which nothing is written"));
  EXPECT_TRUE(fs::is_symlink(place));
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(victim)) {
    ++files;
    EXPECT_EQ(text_of_file(entry.path()), "mine");
  }
  EXPECT_EQ(files, 3u);
}

TEST(Campaign, NothingIsWrittenThroughALinkInItsFolder) {
  expect_not_followed({"manifest.jsonl", {"plan"}});
  for (const char* name : {"runs", "runs/world", "runs/world/seed_1"}) expect_not_followed({name, {"run"}, true});
  for (const char* name : {"study_claim", "study_stamp.txt", "study_failure.txt", "summary.json", "run.log"})
    expect_not_followed({std::string("runs/world/seed_1/") + name, {"run"}});
  for (const char* name : {"study.csv", "points.csv", "study.json", "study.sqlite", "study.sqlite.part", "report.html",
                           "plot.gp", "plot.log", "far.dat", "far.png"})
    expect_not_followed({name, {"collect"}});
  if (std::system("parallel --version > /dev/null 2>&1") == 0)
    for (const char* name : {"parallel.log", "parallel_chunks.txt"})
      expect_not_followed({name, {"run", "--engine", "parallel"}});
}

TEST(Campaign, ItsFolderMayBeALink) {
  const CampaignFolder study("seeds: [1]\n");
  fs::create_directories(study.folder.file("elsewhere"));
  fs::create_symlink(study.folder.file("elsewhere"), study.out());
  EXPECT_EQ(study.call("study").exit_code, 0);
  EXPECT_TRUE(fs::exists(study.folder.file("elsewhere/study.csv")));
}

TEST(Campaign, APageThatIsALinkIsNotFollowed) {
  const CampaignFolder study("seeds: [1]\n");
  ASSERT_EQ(study.call("study").exit_code, 0);
  write_file(study.folder.file("victim"), "mine");
  fs::remove(study.out() + "/report.html");
  fs::create_symlink(study.folder.file("victim"), study.out() + "/report.html");
  const Ended report = run_shoal({"report", study.out()});
  EXPECT_EQ(report.exit_code, 4);
  EXPECT_THAT(report.errors, HasSubstr("/report.html: is a symbolic link"));
  EXPECT_EQ(text_of_file(study.folder.file("victim")), "mine");
}

TEST(Campaign, ReportsBeforeItsRunsThatAResultCannotBeWritten) {
  const CampaignFolder study("seeds: [1]\n");
  fs::create_directories(study.out() + "/study.sqlite");
  const Ended ended = study.call("study");
  EXPECT_EQ(ended.exit_code, 4);
  EXPECT_THAT(ended.errors, HasSubstr("/study.sqlite: cannot be written: it is not a regular file"));
  EXPECT_FALSE(fs::exists(study.out() + "/runs"));
  EXPECT_FALSE(fs::exists(study.out() + "/study.sqlite.part"));
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
  EXPECT_THAT(page, HasSubstr("<td>g = 5 minus g = 1</td>"));
  // Axes from round number to round number, with units.
  EXPECT_THAT(page, HasSubstr(">distance.travelled_m (m)</text>"));
  EXPECT_THAT(page, HasSubstr(">g: physics.gravity_mps2</text>"));
  EXPECT_THAT(page, HasSubstr("text-anchor=\"middle\">4</text>"));
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
  // Nothing is written through a link in place of their folder.
  const std::string elsewhere = study.folder.file("elsewhere");
  fs::create_directories(elsewhere);
  fs::remove_all(study.out() + "/shown");
  fs::create_symlink(elsewhere, study.out() + "/shown");
  const Ended again = study.call("collect", {"--show"});
  EXPECT_EQ(again.exit_code, 4);
  EXPECT_THAT(again.errors, HasSubstr("/shown: is a symbolic link"));
  EXPECT_TRUE(fs::is_empty(elsewhere));
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
  EXPECT_THAT(second.errors, Not(HasSubstr("not judged")));
  // A figure that the world does not have.
  EXPECT_THAT(run_shoal({"tune", folder.file("study.yaml"), "--figure", "distance.traveled"}).errors,
              HasSubstr("--figure: metric 'distance' has no figure 'traveled'"));
}

TEST(Campaign, TuningPrefersAPointThatHoldsTheRulesOfItsWorld) {
  // A ball falls for a second by g / 2; the rule does not hold where the distance is smallest.
  const ScratchFolder folder;
  write_file(folder.file("world.yaml"),
             "shoal: 1\nrun: {duration_s: 1}\nvehicles:\n  - name: m\n    position_m: [0, 0, 20]\n    model:\n"
             "      shoal: 1\n      vehicle: ball\n      bodies: [{name: hull, parts: [{shape: sphere, "
             "radius_m: 0.1, mass_kg: 1}]}]\nmetrics: [{name: distance, type: distance, vehicle: m}]\n"
             "pass: [distance.travelled_m > 2]\n");
  const auto tune = [&](const std::string& to, const std::string& output) {
    write_file(folder.file("study.yaml"),
               "shoal: 1\nstudy: fall\nworld: world.yaml\nseeds: [1]\n"
               "factors: [{name: g, paths: [physics.gravity_mps2], from: 1, to: " +
                   to + "}]\n");
    return run_shoal({"tune", folder.file("study.yaml"), "--figure", "distance.travelled_m", "--generations", "6",
                      "--output", folder.file(output), "--jobs", "2", "--quiet"});
  };
  const Ended some = tune("9", "some");
  EXPECT_EQ(some.exit_code, 0) << some.errors;
  std::smatch best;
  ASSERT_TRUE(std::regex_search(some.output, best, std::regex("best of 24 points: g = ([0-9.]+)\nshoal run ")))
      << some.output;
  EXPECT_GT(std::stod(best[1]), 4.0);
  EXPECT_LT(std::stod(best[1]), 5.0);
  EXPECT_THAT(some.output, Not(HasSubstr("FAILED")));
  const std::string table = text_of_file(folder.file("some/tune.csv"));
  EXPECT_THAT(table, testing::StartsWith("generation,point,g,distance.travelled_m,passed\n"));
  EXPECT_THAT(table, testing::ContainsRegex("\n1,[1-4],[^,]+,[^,]+,1\n"));
  EXPECT_THAT(table, testing::ContainsRegex(",0\n"));
  const Ended none = tune("3", "none");
  EXPECT_EQ(none.exit_code, 1) << none.errors;
  EXPECT_THAT(none.output, HasSubstr("FAILED: a rule of its world fails in 1 of 1 runs at the best point\n"));
}

TEST(Campaign, SlurmGetsPatternsAndJobsOfThisUserOnly) {
  // Programs in place of Slurm's: sbatch executes the tasks of an array at once.
  const CampaignFolder study(six_runs);
  const std::string bin = study.folder.file("bin"), calls = study.folder.file("calls");
  fs::create_directories(bin);
  const auto program = [&](const std::string& name, const std::string& script) {
    write_file(bin + "/" + name, "#!/bin/sh\nprintf '%s\\n' " + name + " \"$@\" >> " + calls + "\n" + script);
    fs::permissions(bin + "/" + name, fs::perms::owner_all);
  };
  program("squeue", "");
  program("scontrol", "echo MaxArraySize = 1001\n");
  program("sbatch",
          "for word in \"$@\"; do case $word in --array=1-*) last=${word#--array=1-} ;; esac; script=$word; done\n"
          "for SLURM_ARRAY_TASK_ID in $(seq \"$last\"); do export SLURM_ARRAY_TASK_ID; sh \"$script\"; done >&2\n"
          "echo 7\n");
  const std::string out = study.folder.file("out%a");
  ASSERT_EQ(run_shoal({"study", "plan", study.folder.file("study.yaml"), "--output", out}).exit_code, 0);
  Program engine({"/usr/bin/env", "PATH=" + bin + ":/usr/bin:/bin", built("shoal"), "study", "run", out, "--engine",
                  "slurm", "--chunk", "2", "--allow-path", study.folder.file("")});
  EXPECT_EQ(engine.wait(), 0) << engine.errors();
  EXPECT_THAT(engine.errors(), HasSubstr("submitted job 7: 6 runs in 3 tasks"));
  const std::string called = text_of_file(calls);
  EXPECT_THAT(called, HasSubstr("--output=" + study.folder.file("out%%a/slurm/%A_%a.log") + "\n"));
  EXPECT_THAT(called, HasSubstr("squeue\n--me\n"));
  EXPECT_TRUE(fs::exists(out + "/runs/world/point_3/seed_2/study_stamp.txt"));
  // Nothing is written through a link to another folder.
  fs::rename(out + "/slurm", out + "/old");
  fs::create_symlink(out + "/old", out + "/slurm");
  fs::remove_all(out + "/runs");
  Program again({"/usr/bin/env", "PATH=" + bin + ":/usr/bin:/bin", built("shoal"), "study", "run", out, "--engine",
                 "slurm", "--allow-path", study.folder.file("")});
  EXPECT_EQ(again.wait(), 4);
  EXPECT_THAT(again.errors(), HasSubstr("/slurm: is a symbolic link"));
  // A backslash would switch off the numbers of the logs.
  const std::string other = study.folder.file("out\\b");
  ASSERT_EQ(run_shoal({"study", "plan", study.folder.file("study.yaml"), "--output", other}).exit_code, 0);
  Program refused({"/usr/bin/env", "PATH=" + bin + ":/usr/bin:/bin", built("shoal"), "study", "run", other, "--engine",
                   "slurm", "--allow-path", study.folder.file("")});
  EXPECT_EQ(refused.wait(), 4);
  EXPECT_THAT(refused.errors(), HasSubstr("must not have a '\\' with the engine slurm"));
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
