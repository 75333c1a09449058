// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "experiment/report/study_report.hpp"
#include "experiment/results/results.hpp"
#include "experiment/study/study_curves.hpp"
#include "experiment/study/study_results.hpp"
#include "experiment/study/study_seeds.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using test_support::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A folder with a world of one metric `e`, and a study of it.
struct StudyFolder {
  explicit StudyFolder(const std::string& more, const std::string& seeds = "[1, 2]") {
    write(folder.file("small.yaml"),
          test::rover_world("        - {name: lidar, type: lidar}\n", "", "",
                            "metrics: [{name: e, type: position_error, vehicle: r1, channel: est}]\n"));
    write(path(), "shoal: 1\nstudy: tiny\nworld: small.yaml\nseeds: " + seeds + "\n" + more);
  }
  std::string path() const { return folder.file("study.yaml"); }
  std::string error() const {
    try {
      experiment::load_study(path());
      return {};
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  }

  ScratchFolder folder;
};

const std::string two_cases =
    "cases:\n"
    "  - {name: plain}\n"
    "  - {name: quick, set: {physics.step_s: 0.002, name: fast}}\n";

/// Runs as if they had been done: `rms` by case, one for each seed; NaN: the figure is null.
std::vector<experiment::StudyRun> made_up_runs(const experiment::LoadedStudy& study,
                                               const std::vector<std::vector<double>>& rms) {
  std::vector<experiment::StudyRun> runs = experiment::plan_study(study, "out");
  for (experiment::StudyRun& run : runs) {
    const double value = rms[run.in_case][static_cast<std::size_t>(run.seed - study.config.seeds[0])];
    run.record.emplace();
    run.record->metrics["e.rms_m"] = std::isnan(value) ? std::nullopt : std::optional<double>(value);
    run.record->judgement = experiment::judgement_of(value < 3);
    run.record->ended = "duration";
    run.record->run_hash = "00000000000000a1";
  }
  return runs;
}

TEST(Statistics, AreThoseOfTheSample) {
  const experiment::Statistics s = experiment::statistics_of({4, 1, 3, std::nan(""), 8});
  EXPECT_EQ(s.count, 4);
  EXPECT_DOUBLE_EQ(s.mean, 4);
  EXPECT_DOUBLE_EQ(s.std, std::sqrt((0.0 + 9 + 1 + 16) / 3));
  EXPECT_DOUBLE_EQ(s.min, 1);
  EXPECT_DOUBLE_EQ(s.max, 8);
  EXPECT_DOUBLE_EQ(s.median, 3.5);
  EXPECT_NEAR(s.mean_95.low, 4 - 3.18245 * s.std / 2, 1e-3);  // Student's t for 3 degrees of freedom
  EXPECT_TRUE(std::isnan(experiment::statistics_of({5}).std));
  EXPECT_TRUE(std::isnan(experiment::statistics_of({5}).mean_95.high));
  EXPECT_DOUBLE_EQ(experiment::statistics_of({5}).mean, 5);
  EXPECT_TRUE(std::isnan(experiment::statistics_of({}).mean));
}

TEST(Statistics, QuantilesLieBetweenNeighbors) {
  const std::vector<double> sorted{0, 10, 20, 30, 40};
  EXPECT_DOUBLE_EQ(experiment::quantile(sorted, 0), 0);
  EXPECT_DOUBLE_EQ(experiment::quantile(sorted, 0.05), 2);
  EXPECT_DOUBLE_EQ(experiment::quantile(sorted, 0.5), 20);
  EXPECT_DOUBLE_EQ(experiment::quantile(sorted, 0.95), 38);
  EXPECT_DOUBLE_EQ(experiment::quantile(sorted, 1), 40);
}

TEST(Curves, AreReadFromTheErrorsOfARun) {
  const ScratchFolder folder;
  write(folder.file("errors.csv"),
        "time_s,metric,error_m,travelled_m\n1,a,0.5,10\n2,b,9,11\n3,a,1.5,20\nrubbish\n4,a,x,30\n5,a,nan,30\n");
  const experiment::Curve by_distance = experiment::read_error_curve(folder.file("errors.csv"), "a", "travelled_m");
  ASSERT_EQ(by_distance.size(), 2u);
  EXPECT_EQ(by_distance[1].x, 20);
  EXPECT_EQ(by_distance[1].error_m, 1.5);
  EXPECT_EQ(experiment::read_error_curve(folder.file("errors.csv"), "a", "time_s")[1].x, 3);
  EXPECT_TRUE(experiment::read_error_curve(folder.file("errors.csv"), "a", "depth_m").empty());
  EXPECT_TRUE(experiment::read_error_curve(folder.file("none.csv"), "a", "time_s").empty());
}

TEST(Curves, BandsLieWhereHalfOfTheRunsAre) {
  // Errors 1, 2 and 3 times x; the third run ends at 5.
  std::vector<experiment::Curve> curves;
  for (const double slope : {1.0, 2.0, 3.0})
    curves.push_back({{0, 0}, {slope < 3 ? 10.0 : 5.0, slope < 3 ? 10 * slope : 15}});
  const auto bands = experiment::bands_of(curves, 11);
  ASSERT_EQ(bands.size(), 11u);
  EXPECT_DOUBLE_EQ(bands[4].x, 4);
  EXPECT_DOUBLE_EQ(bands[4].median, 8);
  EXPECT_DOUBLE_EQ(bands[4].low, 4 + 0.1 * 4);  // 0.05 * (3 - 1) of the way from the first to the second
  EXPECT_DOUBLE_EQ(bands[4].high, 12 - 0.1 * 4);
  EXPECT_EQ(bands[4].runs, 3u);
  EXPECT_EQ(bands[8].runs, 2u);
  EXPECT_DOUBLE_EQ(bands[8].median, 12);
  curves.pop_back();
  curves[1].resize(1);  // one of two runs continues: half
  EXPECT_EQ(experiment::bands_of(curves, 11).size(), 11u);
  curves.push_back(curves[1]);
  EXPECT_EQ(experiment::bands_of(curves, 11).size(), 1u);
  EXPECT_TRUE(experiment::bands_of({}).empty());
}

TEST(StudyConfig, ReadsRangesOfSeeds) {
  const auto seeds = [](const std::string& text) {
    return experiment::load_study(StudyFolder("", text).path()).config.seeds;
  };
  EXPECT_THAT(seeds("3-6"), ElementsAre(3, 4, 5, 6));
  EXPECT_THAT(seeds("7 - 7"), ElementsAre(7));
  EXPECT_THAT(seeds("[1-3, 8]"), ElementsAre(1, 2, 3, 8));
  const auto error = [](const std::string& text) { return StudyFolder("", text).error(); };
  EXPECT_THAT(error("10-1"), HasSubstr("study.yaml:4:8: 'seeds' must be ranges from the lower to the higher seed, got "
                                       "'10-1'"));
  EXPECT_THAT(error("[1-3, 2]"), HasSubstr("'seeds' must differ from each other"));
  EXPECT_THAT(error("[1-3, x]"), HasSubstr("'seeds' must be whole numbers from 0 to 2^53 or ranges such as 1-10, got "
                                           "'x'"));
  EXPECT_THAT(error("1-200000"), HasSubstr("'seeds' must be at most 100000"));
}

TEST(StudyConfig, TakesSeedsAndDurationOfTheCommandLineInstead) {
  EXPECT_THAT(experiment::parse_seeds("1-3,8"), ElementsAre(1, 2, 3, 8));
  EXPECT_THROW(experiment::parse_seeds("1,"), std::invalid_argument);
  EXPECT_THROW(experiment::parse_seeds("1,1"), std::invalid_argument);
  EXPECT_THROW(experiment::parse_seeds("-1"), std::invalid_argument);
  const experiment::LoadedStudy study = experiment::load_study(StudyFolder("").path(), {{5}, 0.5});
  EXPECT_THAT(study.config.seeds, ElementsAre(5));
  EXPECT_EQ(study.config.duration_s, 0.5);
}

TEST(StudyResults, SayWhenCasesDoNotDifferThoughTheirSettingsDo) {
  const StudyFolder folder(two_cases);
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  auto runs = made_up_runs(study, {{1, 2}, {1, 2}});
  const std::string note =
      "cases 'plain', 'quick' do not differ: all runs gave the same result, although their settings differ: check that "
      "the settings have an effect";
  EXPECT_THAT(experiment::StudyResults(study, runs).to_text(), HasSubstr("note: " + note + "\n"));
  const auto json = nlohmann::json::parse(experiment::StudyResults(study, runs).to_json(0));
  EXPECT_EQ(json["notes"], nlohmann::json::array({note}));
  runs[3].record->run_hash = "another";
  EXPECT_THAT(experiment::StudyResults(study, runs).to_text(), HasSubstr("every figure is the same for every seed"));
  runs[3].record->metrics["e.rms_m"] = 2.5;
  EXPECT_THAT(experiment::StudyResults(study, runs).to_text(), testing::Not(HasSubstr("do not differ")));
}

TEST(StudyConfig, ReadsSeedsAsAListOrARange) {
  EXPECT_THAT(experiment::load_study(StudyFolder("").path()).config.seeds, ElementsAre(1, 2));
  EXPECT_THAT(experiment::load_study(StudyFolder("", "{first: 5, count: 3}").path()).config.seeds,
              ElementsAre(5, 6, 7));
}

TEST(StudyConfig, CasesChangeTheWorld) {
  const StudyFolder folder(two_cases);
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  EXPECT_THAT(study.config.cases[1].sets(), ElementsAre("physics.step_s=0.002", "name=fast"));
  EXPECT_EQ(study.worlds[0].config.physics.step_s, 0.001);
  EXPECT_EQ(study.worlds[1].config.physics.step_s, 0.002);
  EXPECT_EQ(study.worlds[1].config.name, "fast");
}

TEST(StudyConfig, WorldIsAFileBesideItOrAShippedOneByName) {
  const ScratchFolder folder;
  const auto world_of = [&](const std::string& world) {
    write(folder.file("study.yaml"), "shoal: 1\nstudy: own\nworld: " + world + "\nseeds: [1]\n");
    return experiment::load_study(folder.file("study.yaml")).config.cases.front().world;
  };
  const std::string shipped =
      std::filesystem::path(test_support::source_path("worlds/minimal.yaml")).lexically_normal();
  EXPECT_EQ(world_of("minimal"), shipped);
  EXPECT_EQ(world_of("minimal.yaml"), shipped);
  std::filesystem::copy_file(shipped, folder.file("minimal.yaml"));
  EXPECT_EQ(world_of("minimal.yaml"), folder.file("minimal.yaml"));
  EXPECT_THROW(world_of("studies/coop_land.yaml"), sim::ConfigError);
}

TEST(StudyConfig, ThoseThatAreShippedCanBeRead) {
  int read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test_support::source_path("worlds/studies"))) {
    EXPECT_NO_THROW(experiment::load_study(entry.path().string())) << entry.path();
    ++read;
  }
  EXPECT_GT(read, 0);
}

TEST(StudyConfig, ReportsWhatIsWrong) {
  const auto error = [](const std::string& more, const std::string& seeds = "[1]") {
    return StudyFolder(more, seeds).error();
  };
  EXPECT_EQ(error(two_cases), "");
  EXPECT_THAT(error("", "[]"), HasSubstr("study.yaml:4:8: 'seeds' must have at least one seed"));
  EXPECT_THAT(error("", "[1, 1]"), HasSubstr("'seeds' must differ from each other"));
  EXPECT_THAT(error("", "~"), HasSubstr("study.yaml:4:8: 'seeds' must have at least one seed"));
  EXPECT_THAT(error("plots: [{name: p, figure: ''}]\n"), HasSubstr("'figure' must not be empty"));
  EXPECT_THAT(error("plots: [{name: p, metrics: [], over: time}]\n"), HasSubstr("'metrics' must not be empty"));
  EXPECT_THAT(error("", "[1.5]"), HasSubstr("'seeds' must be whole numbers, got 1.5"));
  EXPECT_THAT(error("", "[-1]"), HasSubstr("must be >= 0"));
  EXPECT_THAT(error("", "{first: 3}"), HasSubstr("missing key 'count'"));
  EXPECT_THAT(error("", "{count: 0}"), HasSubstr("'count' must be >= 1"));
  EXPECT_THAT(error("sedes: 3\n"), HasSubstr("unknown key 'sedes'"));
  EXPECT_THAT(error("cases: [{name: a}, {name: a}]\n"), HasSubstr("duplicate case 'a'"));
  EXPECT_THAT(error("cases: [{name: ../a}]\n"), HasSubstr("a name must be made of"));
  EXPECT_THAT(error("cases: [{name: a, set: 3}]\n"), HasSubstr("'set' must be a map, got '3'"));
  EXPECT_THAT(error("cases: [{name: a, set: {vehicles.r9.name: x}}]\n"), HasSubstr("r9"));
  EXPECT_THAT(error("cases: [{name: a, set: {physics.step_s: -1}}]\n"), HasSubstr("'step_s' must be"));
  EXPECT_THAT(error("cases: [{name: a, set: {run.duration_s: forever}}]\n"),
              HasSubstr("case 'a': its world runs without end"));
  EXPECT_THAT(error("figures: [e.rms]\n"), HasSubstr("study.yaml:5:10: 'figures' names nothing in this world: 'e.rms'; "
                                                     "known: e.final_m, e.max_gap_s, e.max_m, e.per_distance_percent"));
  EXPECT_THAT(error("plots: [{name: p}]\n"), HasSubstr("plot 'p': needs either 'figure' or 'metrics'"));
  EXPECT_THAT(error("plots: [{name: p, metrics: [e]}]\n"), HasSubstr("'metrics' are drawn over 'distance' or 'time'"));
  EXPECT_THAT(error("plots: [{name: p, metrics: [f], over: time}]\n"), HasSubstr("names nothing in this world: 'f'"));
  EXPECT_THAT(error("plots: [{name: p, figure: passed, cases: [b]}]\n"), HasSubstr("names no case 'b'"));
}

TEST(StudyConfig, NamesNoOtherFilesThanItsWorldMay) {
  const std::string stone = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const ScratchFolder elsewhere;
  write(elsewhere.file("private.obj"), stone);
  const auto error_of = [&](const std::string& more) -> std::string {
    const StudyFolder study(more);
    write(study.folder.file("small.yaml"),
          "shoal: 1\nrun: {duration_s: 1}\n"
          "objects: [{name: o, fixed: true, parts: [{shape: mesh, mesh: own.obj}]}]\n");
    write(study.folder.file("own.obj"), stone);
    experiment::StudyChanges changes;
    changes.load.only_own_files = true;
    try {
      experiment::load_study(study.path(), changes);
      return "";
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  };
  const std::string mesh = "objects.o.parts.1.mesh", other = elsewhere.file("private.obj");
  const std::string rule = "'mesh' must lie below the folder of the world";
  EXPECT_EQ(error_of("cases: [{name: a, set: {" + mesh + ": own.obj}}]\n"), "");
  EXPECT_THAT(error_of("cases: [{name: a, set: {" + mesh + ": " + other + "}}]\n"), HasSubstr(rule));
  // Texts are all checked, not only the first ones.
  const auto factor = [&](const std::string& tenth) {
    std::string values = "own.obj";
    for (int i = 0; i < 8; ++i) values += ", ./" + std::string(static_cast<std::size_t>(i), '/') + "own.obj";
    return "factors: [{name: f, paths: [" + mesh + "], values: [" + values + ", " + tenth + ", ./././own.obj]}]\n";
  };
  EXPECT_EQ(error_of(factor("././own.obj")), "");
  EXPECT_THAT(error_of(factor(other)), HasSubstr(rule));
}

TEST(StudyConfig, ReportsWhatIsWrongWithFactorsAndTheirDesign) {
  const auto error = [](const std::string& factor, const std::string& more = "") {
    return StudyFolder("factors:\n  - {name: g, paths: [physics.gravity_mps2], " + factor + "}\n" + more).error();
  };
  EXPECT_EQ(error("values: [1, 2]"), "");
  EXPECT_EQ(error("from: 1, to: 2, levels: 3"), "");
  EXPECT_EQ(error("from: 1, to: 2", "design: {type: sobol, points: 7}\n"), "");
  EXPECT_THAT(error("from: 1, to: 2"), HasSubstr("study.yaml:6:5: factor 'g': a range in a grid needs 'levels'"));
  EXPECT_THAT(error("values: []"), HasSubstr("'values' must not be empty"));
  EXPECT_THAT(error("from: 1"), HasSubstr("factor 'g': has 'from' but no 'to'"));
  EXPECT_THAT(error("from: 2, to: 1, levels: 2"), HasSubstr("'to' must be greater than 'from', got 1"));
  EXPECT_THAT(error("values: [1], from: 1, to: 2"), HasSubstr("needs either 'values' or 'from' and 'to', not both"));
  EXPECT_THAT(error("from: 0, to: 1, levels: 2, scale: log"), HasSubstr("'from' must be > 0 with 'scale: log', got 0"));
  EXPECT_THAT(error("values: [1, x]"), HasSubstr("factor 'g': value x: "));
  EXPECT_THAT(error("values: [1]", "design: {type: random}\n"), HasSubstr("needs 'points'"));
  EXPECT_THAT(error("values: [1]", "design: {points: 3}\n"), HasSubstr("a grid has no 'points'"));
  EXPECT_THAT(error("values: [1]", "design: {type: sobol, points: 3, seed: 2}\n"),
              HasSubstr("only the designs random and latin_hypercube have a 'seed'"));
  EXPECT_THAT(StudyFolder("design: {type: grid}\n").error(), HasSubstr("'design' needs 'factors'"));
  EXPECT_THAT(StudyFolder("factors: [{name: seed, paths: [a], values: [1]}]\n").error(),
              HasSubstr("'name' must not be that of another column of the tables, got 'seed'"));
  EXPECT_THAT(StudyFolder("batch: 5\n").error(), HasSubstr("'batch' needs 'until'"));
  EXPECT_THAT(StudyFolder("until: ci(e.rms) < 5 %\n").error(),
              HasSubstr("'until' names nothing in this world: 'e.rms'"));
}

TEST(StudyConfig, PointsAtTheMistakeInARule) {
  const auto error = [](const std::string& rule) {
    const std::string text = StudyFolder("pass: ['" + rule + "']\n", "[1]").error();
    const std::size_t at = text.find("study.yaml:5:");
    return at == std::string::npos ? text : text.substr(at + 13);
  };
  EXPECT_EQ(error("mean(world.passed) == 1"), "");
  EXPECT_EQ(error("max(world.e.rms_m) < 0.5 * min(world.e.rms_m)"), "");
  // The text begins at column 9.
  EXPECT_EQ(error("avg(world.e.rms_m) < 1"),
            "9: rule 1: unknown statistic 'avg'; known statistics: mean, std, min, max, median");
  EXPECT_THAT(error("meam(world.e.rms_m) < 1"), HasSubstr("did you mean 'mean'?"));
  EXPECT_EQ(error("max(word.e.rms_m) < 1"),
            "13: rule 1: unknown case 'word'; known cases: world; did you mean 'world'?");
  EXPECT_EQ(error("1 > max(world.x.rms_m)"), "23: rule 1: unknown metric 'x'; known metrics: e");
  EXPECT_THAT(error("max(world.e.rms) < 1"), HasSubstr("21: rule 1: metric 'e' has no figure 'rms'; figures: rms_m, "));
  EXPECT_THAT(error("max(world.e) < 1"), HasSubstr("19: rule 1: 'e' is a metric; a rule names one of its figures"));
  EXPECT_EQ(error("max(world) < 1"), "13: rule 1: case 'world' needs one of its figures, such as world.passed");
  const std::string known = "'; statistics: mean, std, min, max, median";
  const std::string needs = "9: rule 1: a rule of a study needs a statistic over the seeds, such as 'mean(";
  EXPECT_EQ(error("world.e.rms_m < 1"), needs + "world.e.rms_m)" + known);
  EXPECT_EQ(error("e.rms_m < 1"), needs + "world.e.rms_m)" + known);
  EXPECT_EQ(error("passed == 1"), needs + "world.passed)" + known);
  EXPECT_THAT(error("nan < 1"), HasSubstr("9: rule 1: 'nan' is neither a number nor a statistic"));
  EXPECT_EQ(error("max(world.e.rms_m)"), "27: rule 1: the rule has no comparison; write one of < <= > >= == !=");
}

TEST(StudyConfig, RefusesRulesThatAreNoText) {
  EXPECT_THAT(StudyFolder("pass: [{case: a, figure: e.rms_m, below: 1}]\n", "[1]").error(),
              HasSubstr("rule 1: a rule is text, a comparison such as"));
  EXPECT_THAT(StudyFolder("pass: passed\n").error(), HasSubstr("'pass' must be a list of rules, got 'passed'"));
}

TEST(StudyConfig, ReportsWhatIsWrongWithASettingWhereItStands) {
  EXPECT_THAT(StudyFolder("cases:\n  - {name: a, set: {physics.step_s: -1}}\n").error(),
              HasSubstr("study.yaml:6:37: case 'a': 'physics.step_s': physics: 'step_s' must be"));
}

TEST(StudyConfig, WarnsOnceOfWhatIsWrongInAllCases) {
  const StudyFolder folder("cases: [{name: a}, {name: b}, {name: c}]\n");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  experiment::load_study(folder.path());
  const std::string log = testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
  const std::string warning = "nothing in this world publishes on 'est'";
  const std::size_t first = log.find(warning);
  ASSERT_NE(first, std::string::npos) << log;
  EXPECT_EQ(log.find(warning, first + 1), std::string::npos) << log;
}

TEST(StudyResults, JudgeStatisticsOfCases) {
  const StudyFolder folder(two_cases +
                           "pass:\n"
                           "  - mean(plain.e.rms_m) < 2.5\n"                        // mean 2
                           "  - max(plain.e.rms_m) < 2.5\n"                         // max 3
                           "  - mean(plain.e.rms_m) < 0.5 * mean(quick.e.rms_m)\n"  // 2 < 0.5 * 6
                           "  - mean(plain.e.rms_m) < mean(plain.e.rms_m)\n"        // 2 < 2
                           "  - mean(plain.passed) == 0.5\n"                        // 1 < 3, not 3 < 3
                           "  - std(quick.e.rms_m) > 0\n"                           // equal ones
                           "  - mean(quick.e.final_m) > -1\n");                     // no one has it
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  const auto runs = made_up_runs(study, {{1, 3}, {6, 6}});
  const experiment::StudyResults results(study, runs);
  std::vector<bool> passed;
  for (const auto& verdict : results.verdicts()) passed.push_back(verdict.passed);
  EXPECT_THAT(passed, ElementsAre(true, false, true, false, true, false, false));
  EXPECT_EQ(results.judgement(), experiment::Judgement::failed);
  EXPECT_EQ(results.verdicts()[2].text(),
            "mean(plain.e.rms_m) < 0.5 * mean(quick.e.rms_m) (left 2, right 3, margin 1)");
  EXPECT_THAT(results.to_text(), HasSubstr("FAILED: max(plain.e.rms_m) < 2.5 (left 3, right 2.5, margin -0.5)"));
  const auto json = nlohmann::json::parse(results.to_json(1));
  EXPECT_EQ(json["rules"][1]["rule"], "max(plain.e.rms_m) < 2.5");
  EXPECT_EQ(json["rules"][1]["left"], 3);
  EXPECT_EQ(json["rules"][1]["margin"], -0.5);
  EXPECT_TRUE(json["rules"][6]["left"].is_null());
  EXPECT_EQ(json["cases"][0]["figures"]["e.rms_m"]["mean"], 2);
  EXPECT_NEAR(json["cases"][0]["figures"]["e.rms_m"]["mean_high_95"], 2 + 12.7062, 1e-3);  // std / sqrt(2) is 1
  EXPECT_NEAR(json["cases"][1]["figures"]["passed"]["mean_high_95"], 0.657620, 1e-5);      // 0 of 2: z^2 / (2 + z^2)
  EXPECT_EQ(json["cases"][1]["figures"]["e.rms_m"]["std"], 0);
  EXPECT_EQ(json["passed"], false);
  EXPECT_THAT(results.to_csv(), HasSubstr("case,seed,exit_code,passed,ended,sim_time_s,wall_s,run_hash,e.rms_m,run,"
                                          "point,shoal,processor,c_library\n"
                                          "plain,1,0,1,duration,0,0.000,00000000000000a1,1,1,0,,,\n"));
  EXPECT_THAT(results.to_csv(), HasSubstr("quick,2,0,0,duration,0,0.000,00000000000000a1,6,4,0,,,\n"));
}

TEST(StudyResults, ARuleFailsWhenARunLacksItsFigure) {
  const StudyFolder folder(two_cases +
                           "pass:\n"
                           "  - max(quick.e.rms_m) < 10\n"
                           "  - min(quick.e.rms_m) > 1\n"
                           "  - mean(quick.e.rms_m) == 6\n"
                           "  - mean(plain.e.rms_m) < mean(quick.e.rms_m)\n"
                           "  - mean(plain.e.rms_m) < 10\n");
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  const auto runs = made_up_runs(study, {{1, 3}, {6, std::nan("")}});
  const experiment::StudyResults results(study, runs);
  std::vector<bool> passed;
  for (const auto& verdict : results.verdicts()) passed.push_back(verdict.passed);
  EXPECT_THAT(passed, ElementsAre(false, false, false, false, true));
  EXPECT_EQ(results.verdicts()[0].text(),
            "max(quick.e.rms_m) < 10 (max(quick.e.rms_m) is none: 1 of 2 runs has no such figure)");
  EXPECT_THAT(results.to_text(), testing::ContainsRegex("e.rms_m +quick +1/2 "));
  EXPECT_THAT(results.to_text(), testing::ContainsRegex("e.rms_m +plain +2 "));
  const auto json = nlohmann::json::parse(results.to_json(1));
  EXPECT_EQ(json["cases"][1]["figures"]["e.rms_m"]["count"], 1);
  EXPECT_TRUE(json["cases"][1]["figures"]["e.rms_m"]["std"].is_null());
  EXPECT_THAT(results.to_csv(), HasSubstr("quick,2,0,0,duration,0,0.000,00000000000000a1,,4,0,,,\n"));
}

TEST(StudyResults, WithoutRulesNothingHasPassed) {
  const StudyFolder folder(two_cases);
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  const auto runs = made_up_runs(study, {{1, 3}, {6, 7}});
  const experiment::StudyResults results(study, runs);
  EXPECT_THAT(results.to_text(), HasSubstr("not judged: the study has no rules\n"));
  const auto json = nlohmann::json::parse(results.to_json(0));
  EXPECT_TRUE(json["passed"].is_null()) << json["passed"];
  EXPECT_EQ(json.value("judged", true), false);
  const ScratchFolder out;
  experiment::write_study(out.file("study"), study, runs, results, 0);
  const std::string page = experiment::study_report(out.file("study"));
  EXPECT_THAT(page, HasSubstr("not judged</span>: the study has no rules"));
  EXPECT_THAT(page, testing::Not(HasSubstr("passed</span>")));
}

TEST(StudyResults, ARunThatNoOneJudgedHasNotPassed) {
  const StudyFolder folder("launch: false\npass: [mean(world.passed) == 1]\n");
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  auto runs = experiment::plan_study(study, "out");
  const ScratchFolder results_of_runs;
  for (experiment::StudyRun& run : runs) {
    experiment::Summary summary;
    summary.seed = run.seed;
    if (run.seed == 1) summary.verdicts = {{"a", true}};
    experiment::write_summary(results_of_runs.file(std::to_string(run.seed)), summary);
    run.record = experiment::read_run(results_of_runs.file(std::to_string(run.seed)));
  }
  const experiment::StudyResults results(study, runs);
  EXPECT_EQ(results.of("world", "passed").count, 1);
  EXPECT_EQ(results.verdicts().at(0).passed, false);
  EXPECT_EQ(results.verdicts().at(0).text(),
            "mean(world.passed) == 1 (mean(world.passed) is none: 1 of 2 runs has no such figure)");
  EXPECT_THAT(results.to_csv(), HasSubstr("\nworld,1,0,1,"));
  EXPECT_THAT(results.to_csv(), HasSubstr("\nworld,2,0,,"));
}

TEST(StudyResults, CountRunsWithoutAResult) {
  const StudyFolder folder(two_cases);
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  auto runs = made_up_runs(study, {{1, 3}, {6, 7}});
  runs[3].record.reset();
  runs[3].failure = "<b>exit code 4</b>";
  const experiment::StudyResults results(study, runs);
  EXPECT_EQ(results.failed_runs(), 1u);
  EXPECT_EQ(results.judgement(), experiment::Judgement::failed);
  EXPECT_THAT(results.to_csv(), HasSubstr("quick,2,,,failed,,,,,4,0,,,\n"));
  const ScratchFolder out;
  experiment::write_study(out.file("study"), study, runs, results, 4);
  const std::string page = experiment::study_report(out.file("study"));
  EXPECT_THAT(page, HasSubstr("quick, seed 2: &lt;b&gt;exit code 4&lt;/b&gt;"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">plain</th><td>2</td><td>2</td>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">quick</th><td>1 of 2</td><td>6</td>"));
}

}  // namespace
