// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/algorithm_table.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "experiment/campaign/verified_runs.hpp"
#include "experiment/report/report_page.hpp"
#include "experiment/study/study_algorithms.hpp"
#include "tests/experiment/study/algorithm_study.hpp"

namespace {

using namespace algorithm_study;

using testing::HasSubstr;

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

}  // namespace
