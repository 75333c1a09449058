// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_curves.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "experiment/report/report_page.hpp"
#include "experiment/results/results.hpp"
#include "experiment/study/study_config.hpp"
#include "experiment/study/study_results.hpp"
#include "tests/experiment/study/study_folder.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using namespace study_folder;

using test_support::ScratchFolder;

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

}  // namespace
