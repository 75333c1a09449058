// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "experiment/report/report_page.hpp"
#include "experiment/results/results.hpp"
#include "experiment/study/study_config.hpp"
#include "experiment/study/study_curves.hpp"
#include "experiment/study/study_results.hpp"
#include "tests/experiment/study/study_folder.hpp"

namespace {

using namespace study_folder;

using testing::HasSubstr;

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

}  // namespace
