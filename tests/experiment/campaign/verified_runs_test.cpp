// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/campaign/verified_runs.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "experiment/report/report_page.hpp"
#include "experiment/study/algorithm_table.hpp"
#include "experiment/study/study_algorithms.hpp"
#include "tests/experiment/study/algorithm_study.hpp"

namespace {

using namespace algorithm_study;

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
