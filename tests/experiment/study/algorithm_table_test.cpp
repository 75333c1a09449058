// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/algorithm_table.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "experiment/campaign/verified_runs.hpp"
#include "experiment/report/study_report.hpp"
#include "experiment/study/study_algorithms.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using test_support::ScratchFolder;
using testing::HasSubstr;

constexpr const char* bounds = "metrics: [{name: b, type: bound, vehicle: r1, from_s: 5}]\n";

/// A study of a rover with GPS, by two algorithms; `more`: further keys, `metrics` of its world.
struct AlgorithmStudy {
  explicit AlgorithmStudy(const std::string& more = "algorithms: [ci, iu]\n", const std::string& metrics = bounds) {
    write("small.yaml", test::rover_world("        - {name: gps, type: gps, rate_hz: 1}\n", "", "", metrics));
    write("study.yaml", "shoal: 1\nstudy: tiny\nworlds: [small.yaml]\nlaunch: true\nseeds: 1-5\n" + more);
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder.file(name), std::ios::binary) << text;
  }
  experiment::LoadedStudy load(const experiment::StudyChanges& changes = {}) const {
    return experiment::load_study(folder.file("study.yaml"), changes);
  }
  std::string error() const {
    try {
      load();
      return {};
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  }
  ScratchFolder folder;
};

/// Runs with these rms by algorithm and seed, a bound of 1 m and a NEES by algorithm.
std::vector<experiment::StudyRun> runs_with(const experiment::LoadedStudy& study,
                                            const std::map<std::string, std::vector<double>>& rms,
                                            const std::map<std::string, std::vector<double>>& nees) {
  std::vector<experiment::StudyRun> runs = experiment::plan_study(study, "out");
  for (experiment::StudyRun& run : runs) {
    const auto seed = static_cast<std::size_t>(run.seed - 1);
    run.record.emplace();
    run.record->run_hash = "00000000000000a1";
    for (const auto& [label, values] : rms) {
      auto& metrics = run.record->metrics;
      metrics[label + ".rms_m"] = values[seed];
      metrics[label + ".ratio"] = values[seed];
      metrics[label + ".nees_mean"] = nees.at(label)[seed];
      metrics[label + ".inside_95_share"] = 0.9;
      metrics[label + ".bytes_per_h"] = 1000;
      metrics[label + ".us_per_event"] = 1 + static_cast<double>(seed);
    }
  }
  return runs;
}

TEST(AlgorithmTable, HasTheRootMeanSquareTheEfficiencyAndTheNeesOverTheSeeds) {
  const AlgorithmStudy folder;
  const experiment::LoadedStudy study = folder.load();
  const auto runs = runs_with(study, {{"ci", {2, 2, 4, 4, 3}}, {"iu", {1, 1, 2, 2, 1.5}}},
                              {{"ci", {8, 9, 9, 10, 9}}, {"iu", {1.5, 2, 2.5, 2, 2}}});
  const experiment::StudyResults results(study, runs);
  const experiment::AlgorithmTable table(results);
  ASSERT_EQ(table.cells().size(), 2u);
  const experiment::AlgorithmCell& ci = table.cells()[0];
  EXPECT_EQ(ci.world, "small");
  EXPECT_EQ(ci.runs, 5u);
  EXPECT_DOUBLE_EQ(ci.rms_m, std::sqrt(9.8));           // sqrt((4 + 4 + 16 + 16 + 9) / 5)
  EXPECT_DOUBLE_EQ(ci.efficiency, 1 / std::sqrt(9.8));  // the bound is 1 m in each run
  EXPECT_DOUBLE_EQ(ci.us_per_event, 3);                 // median of 1 to 5
  EXPECT_GE(ci.rms_95.low, 2);                          // percentiles of samples lie among the values
  EXPECT_LT(ci.rms_95.low, ci.rms_m);
  EXPECT_LE(ci.rms_95.high, 4);
  EXPECT_GT(ci.rms_95.high, ci.rms_m);
  EXPECT_EQ(ci.trust, experiment::Trust::overconfident);             // 9 -/+ 2.78 x 0.707 / sqrt(5) lies above 2
  EXPECT_EQ(table.cells()[1].trust, experiment::Trust::consistent);  // 2 -/+ 2.78 x 0.354 / sqrt(5) holds 2
}

TEST(AlgorithmTable, CallsACovarianceUnclearWhenAFewRunsDecide) {
  const AlgorithmStudy folder;
  const experiment::LoadedStudy study = folder.load();
  const auto runs = runs_with(study, {{"ci", {2, 2, 4, 4, 3}}, {"iu", {1, 1, 2, 2, 1.5}}},
                              {{"ci", {1, 1, 1, 1, 21}}, {"iu", {1.5, 2, 2.5, 2, 2}}});
  const experiment::StudyResults results(study, runs);
  const experiment::AlgorithmTable table(results);
  EXPECT_EQ(table.cells()[0].trust, experiment::Trust::unclear);  // 5 -/+ 2.78 x 8.94 / sqrt(5): -6 to 16
}

TEST(AlgorithmTable, ComparesInPairsOfEqualSeedsByTheirRatio) {
  const AlgorithmStudy folder;
  const experiment::LoadedStudy study = folder.load();
  const auto runs = runs_with(study, {{"ci", {2, 2, 4, 4, 3}}, {"iu", {1, 1, 2, 2, 1.5}}},
                              {{"ci", {2, 2, 2, 2, 2}}, {"iu", {9, 8, 9, 8, 8.5}}});
  const experiment::StudyResults results(study, runs);
  const experiment::AlgorithmTable table(results);
  ASSERT_EQ(table.pairs().size(), 1u);
  EXPECT_EQ(table.pairs()[0].algorithm, "iu");
  EXPECT_EQ(table.pairs()[0].base, "ci");  // the first one without `pairs`
  EXPECT_DOUBLE_EQ(table.pairs()[0].factor, 0.5);
  EXPECT_DOUBLE_EQ(table.pairs()[0].factor_95.high, 0.5);  // every pair has this ratio
  EXPECT_DOUBLE_EQ(table.pairs()[0].wilcoxon_p, 0.0625);   // 2 of 2^5 choices of signs
  ASSERT_EQ(table.sentences().size(), 1u);
  EXPECT_THAT(table.sentences()[0],
              HasSubstr("small: iu has the smallest rms, 1.57 m, then ci with 3.13 m; ratio in pairs 2 [2, 2]"));
  EXPECT_THAT(table.sentences()[0], HasSubstr("iu is overconfident (NEES 8.5), the best that is not is ci"));
  EXPECT_EQ(experiment::AlgorithmTable(results).text(), table.text());  // the bootstrap has a fixed seed
}

TEST(AlgorithmTable, IsOnThePageOfTheStudy) {
  const AlgorithmStudy folder;
  const experiment::LoadedStudy study = folder.load();
  const auto runs = runs_with(study, {{"ci", {2, 2, 4, 4, 3}}, {"iu", {1, 1, 2, 2, 1.5}}},
                              {{"ci", {8, 9, 9, 10, 9}}, {"iu", {2, 2, 2, 1, 2}}});
  const experiment::StudyResults results(study, runs);
  folder.write("study.json", results.to_json(0));
  const std::string page = experiment::study_report(folder.folder.file(""));
  EXPECT_THAT(page, HasSubstr("<h2>Algorithms</h2>"));
  EXPECT_THAT(page, HasSubstr("m<br><span style=\"color:#d03030\" title=\"overconfident\">NEES 9 ["));
  EXPECT_THAT(page, HasSubstr("Ratios of the rms in pairs of equal seeds"));
  EXPECT_THAT(page, HasSubstr("<svg"));
}

TEST(AlgorithmTable, LeavesOutRunsWithoutEstimates) {
  const AlgorithmStudy folder;
  const experiment::LoadedStudy study = folder.load();
  auto runs = runs_with(study, {{"ci", {2, 2, 2, 2, 2}}, {"iu", {1, 1, 1, 1, 1}}},
                        {{"ci", {2, 2, 2, 2, 2}}, {"iu", {2, 2, 2, 2, 2}}});
  for (experiment::StudyRun& run : runs) run.record->metrics["iu.rms_m"] = std::nullopt;
  runs[0].record.reset();
  const experiment::StudyResults results(study, runs);
  const experiment::AlgorithmTable table(results);
  EXPECT_EQ(table.cells()[0].runs, 4u);
  EXPECT_EQ(table.cells()[0].planned, 5u);
  EXPECT_EQ(table.cells()[1].runs, 0u);
  EXPECT_TRUE(std::isnan(table.cells()[1].rms_m));
  EXPECT_TRUE(table.sentences().empty());  // what lacks a run is not ranked
}

TEST(StudyAlgorithms, ComputeTheFiguresOfTheTeamFromTheFileOfShoalNav) {
  const AlgorithmStudy folder("algorithms: [ci]\n");
  const experiment::LoadedStudy study = folder.load();
  std::vector<experiment::StudyRun> runs = experiment::plan_study(study, folder.folder.file(""));
  experiment::StudyRun& run = runs[0];
  run.directory = folder.folder.file("");
  run.record.emplace();
  run.record->metrics["b.rms_m"] = 2;
  const auto scores = [&](const std::string& vehicle) {
    folder.write("algorithms.json", R"({"algorithms": [{"name": "ci", "us_per_event": 0.5, "vehicles": {"r1": {)" +
                                        vehicle + R"(}, "other": {}}}]})");
  };
  scores(R"("rms_m": 3, "nees_mean": 2.5, "inside_95_share": 0.9, "samples": 10, "bytes_per_h": 70)");
  experiment::add_algorithm_figures(study, run);
  EXPECT_DOUBLE_EQ(*run.record->metrics.at("ci.rms_m"), 3);
  EXPECT_DOUBLE_EQ(*run.record->metrics.at("ci.ratio"), 1.5);
  EXPECT_DOUBLE_EQ(*run.record->metrics.at("ci.nees_mean"), 2.5);
  EXPECT_DOUBLE_EQ(*run.record->metrics.at("ci.bytes_per_h"), 70);
  scores(R"("rms_m": null, "nees_mean": null, "inside_95_share": null, "samples": 0, "bytes_per_h": 70)");
  experiment::add_algorithm_figures(study, run);
  EXPECT_FALSE(run.record->metrics.at("ci.rms_m"));
  scores(R"("rms_m": "3")");
  EXPECT_THROW(experiment::add_algorithm_figures(study, run), std::runtime_error);
  folder.write("algorithms.json", R"({"algorithms": []})");
  EXPECT_THROW(experiment::add_algorithm_figures(study, run), std::runtime_error);
}

TEST(StudyAlgorithms, NeedWhatIsScored) {
  const auto error = [](const std::string& more, const std::string& metrics = bounds) {
    return AlgorithmStudy(more, metrics).error();
  };
  EXPECT_EQ(error("algorithms: [ci]\npass: [mean(small.ci.ratio) < 2]\nfigures: [ci.rms_m, b.rms_m]\n"), "");
  EXPECT_THAT(error("algorithms: [ci]\n", ""),
              HasSubstr("study.yaml:6:13: 'algorithms' need a metric of type 'bound'"));
  EXPECT_THAT(error("algorithms: [ci, ci]\n"), HasSubstr("'algorithms' must differ from each other"));
  EXPECT_THAT(error("algorithms: ['python:a.B']\n"), HasSubstr("an own class in Python is given with --algorithm"));
  EXPECT_THAT(error("algorithms: [ci]\npairs: iu\n"), HasSubstr("'pairs' must be one of 'algorithms', got 'iu'"));
  EXPECT_THAT(error("algorithms: [b]\n"), HasSubstr("metric 'b' has the name of an algorithm of the study"));
  EXPECT_THAT(error("algorithms: [ci]\npass: [mean(small.iu.rms_m) < 2]\n"), HasSubstr("unknown metric 'iu'"));
  EXPECT_THAT(error("algorithms: [ci]\nworld: small.yaml\n"), HasSubstr("needs either 'world' or 'worlds', not both"));
  EXPECT_THAT(error("cases: [{name: a}]\n"), HasSubstr("case 'a' needs a 'world', because the study has none"));
  EXPECT_THAT(error("cases: [{name: small, world: small.yaml}]\n"), HasSubstr("has the name of one of 'worlds'"));
  EXPECT_EQ(error("cases: [{name: fine, world: small.yaml, set: {physics.step_s: 0.001}}]\n"), "");
}

TEST(StudyAlgorithms, AreScoredByTheLastBoundOfEachVehicleFromOneTimeOn) {
  const AlgorithmStudy folder(
      "algorithms: [ci]\n",
      "metrics: [{name: b, type: bound, vehicle: r1, from_s: 5}, {name: c, type: bound, vehicle: r1, from_s: 7}]\n");
  const experiment::LoadedStudy study = folder.load();
  const auto scoring = experiment::algorithm_scoring(study.worlds[0].config, study.config.algorithms, {});
  ASSERT_EQ(scoring.vehicles.size(), 1u);
  EXPECT_EQ(scoring.vehicles[0].bound, "c");
  EXPECT_EQ(scoring.from_s, 7);
  folder.write("study.yaml",
               "shoal: 1\nstudy: own\nlaunch: true\nseeds: [1]\nalgorithms: [ci]\ncases:\n  - {name: a, world: " +
                   test_support::source_path("worlds/benchmark/13_coop_land.yaml") +
                   ", set: {metrics.bound_rover1.from_s: 5}}\n");
  EXPECT_THAT(folder.error(), HasSubstr("must have equal 'from_s' for a study with algorithms, got 30 and 5"));
}

TEST(StudyAlgorithms, OfTheCommandLineAreAddedByTheNameOfTheirClass) {
  const AlgorithmStudy folder;
  experiment::StudyChanges changes;
  changes.algorithms = {"python:some/where/mine.Mine"};
  const experiment::LoadedStudy study = folder.load(changes);
  EXPECT_EQ(study.config.algorithms.size(), 3u);
  EXPECT_EQ(experiment::algorithm_label(study.config.algorithms[2]), "Mine");
  changes.algorithms = {"python:mine.ci"};
  EXPECT_THROW(folder.load(changes), std::invalid_argument);
  const experiment::StudyRun run = experiment::plan_study(study, "out").front();
  EXPECT_NE(experiment::inputs_of(study, run), experiment::inputs_of(folder.load(), run));
}

TEST(VerifiedRuns, AreComparedInAllFiguresButTheCpuTime) {
  const AlgorithmStudy folder;
  const experiment::LoadedStudy study = folder.load();
  auto runs = runs_with(study, {{"ci", {2, 2, 4, 1.0 / 3, 2}}, {"iu", {1, 1, 2, 2, 2}}},
                        {{"ci", {2, 2, 2, 2, 2}}, {"iu", {2, 2, 2, 2, 2}}});
  const experiment::StudyResults results(study, runs);
  const auto rows = experiment::parse_study_rows(results.to_csv(), "study.csv");
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[3].seed, 4);
  experiment::StudyRun& run = runs[3];
  run.record->metrics["ci.us_per_event"] = 77;
  EXPECT_TRUE(experiment::compare_with_row(run, rows[3]).differences.empty());
  EXPECT_EQ(experiment::compare_with_row(run, rows[3]).figures, 10u);  // five of each algorithm
  run.record->metrics["ci.rms_m"] = std::nextafter(1.0 / 3, 1);
  EXPECT_EQ(experiment::compare_with_row(run, rows[3]).differences.size(), 1u);
  run.record->run_hash = "00000000000000a2";
  run.record->metrics.erase("iu.rms_m");
  EXPECT_EQ(experiment::compare_with_row(run, rows[3]).differences.size(), 3u);
}

TEST(VerifiedRuns, ATableThatIsWrongIsRefusedWithItsLine) {
  const std::string head =
      "case,seed,exit_code,passed,ended,sim_time_s,wall_s,run_hash,ci.rms_m,run,point,shoal,processor,c_library\n";
  const auto error = [](const std::string& text) -> std::string {
    try {
      experiment::parse_study_rows(text, "study.csv");
      return {};
    } catch (const std::runtime_error& wrong) {
      return wrong.what();
    }
  };
  EXPECT_EQ(error(head), "");
  EXPECT_EQ(error(""), "study.csv: is empty");
  EXPECT_EQ(error("a,b\n"), "study.csv:1: column 1 must be 'case': this is not a study.csv of shoal");
  EXPECT_EQ(error(head + "w,1\n"), "study.csv:2: must have 14 fields, got 2");
  EXPECT_EQ(error(head + "w,x,0,1,duration,1,1,a1,1,1,0,0,0,0\n"),
            "study.csv:2: 'seed' must be a whole number from 0 on, got 'x'");
  EXPECT_EQ(error(head + "w,1,0,1,duration,1,1,a1,1.5m,1,0,0,0,0\n"),
            "study.csv:2: 'ci.rms_m' must be a number, got '1.5m'");
  EXPECT_EQ(error(head + "w,1,\"0\n"), "study.csv:2: a quote is not closed");
  const std::string row = "w,1,0,1,duration,1,1,a1,1,1,0,0,0,0\n";
  EXPECT_EQ(error(head + row + row), "study.csv:3: a second row of case 'w', seed 1");
  std::string twice = head;
  twice.replace(twice.find(",run,"), 5, ",ci.rms_m,run,");
  EXPECT_EQ(error(twice), "study.csv:1: each column must be named once");
}

}  // namespace
