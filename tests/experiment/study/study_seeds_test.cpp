// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_seeds.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "experiment/report/study_report.hpp"
#include "experiment/results/results.hpp"
#include "experiment/study/study_curves.hpp"
#include "experiment/study/study_results.hpp"
#include "tests/experiment/study/study_folder.hpp"

namespace {

using namespace study_folder;

using testing::ElementsAre;
using testing::HasSubstr;

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

TEST(StudyConfig, ReadsSeedsAsAListOrARange) {
  EXPECT_THAT(experiment::load_study(StudyFolder("").path()).config.seeds, ElementsAre(1, 2));
  EXPECT_THAT(experiment::load_study(StudyFolder("", "{first: 5, count: 3}").path()).config.seeds,
              ElementsAre(5, 6, 7));
}

}  // namespace
