// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_rules.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "experiment/report/report_page.hpp"
#include "experiment/results/results.hpp"
#include "experiment/study/study_config.hpp"
#include "experiment/study/study_curves.hpp"
#include "experiment/study/study_results.hpp"
#include "tests/experiment/study/study_folder.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using namespace study_folder;

using test_support::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;

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

}  // namespace
