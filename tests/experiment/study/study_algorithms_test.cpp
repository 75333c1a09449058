// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_algorithms.hpp"

#include <gmock/gmock.h>

#include "experiment/campaign/verified_runs.hpp"
#include "experiment/report/report_page.hpp"
#include "experiment/study/algorithm_table.hpp"
#include "tests/experiment/study/algorithm_study.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using namespace algorithm_study;

using testing::HasSubstr;

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

}  // namespace
