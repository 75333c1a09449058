// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_results.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiment/report/report_page.hpp"
#include "experiment/results/results.hpp"
#include "experiment/study/study_config.hpp"
#include "experiment/study/study_curves.hpp"
#include "tests/experiment/study/study_folder.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using namespace study_folder;

using test_support::ScratchFolder;
using testing::HasSubstr;

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
