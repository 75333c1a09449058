// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_runs.hpp"

#include <gmock/gmock.h>

#include "experiment/study/load_study.hpp"
#include "tests/experiment/study/study_folder.hpp"

namespace {

using namespace study_folder;

TEST(StudyRuns, AreInTheOrderOfCasesPointsAndSeeds) {
  const StudyFolder folder(two_cases + "factors: [{name: step, paths: [physics.step_s], values: [0.001, 0.01]}]\n",
                           "[7, 3]");
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  const std::vector<experiment::StudyRun> runs = experiment::plan_study(study, "out");
  ASSERT_EQ(runs.size(), 8u);
  EXPECT_EQ(runs[0].directory, "out/runs/plain/point_1/seed_7");
  EXPECT_EQ(runs[1].directory, "out/runs/plain/point_1/seed_3");
  EXPECT_EQ(runs[2].directory, "out/runs/plain/point_2/seed_7");
  EXPECT_EQ(runs[4].directory, "out/runs/quick/point_1/seed_7");
  for (std::size_t i = 0; i < runs.size(); ++i) EXPECT_EQ(runs[i].index, i + 1);
}

TEST(StudyRuns, WithoutFactorsHaveNoPoints) {
  const StudyFolder folder(two_cases);
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  EXPECT_EQ(experiment::plan_study(study, "out")[0].directory, "out/runs/plain/seed_1");
}

TEST(StudyRuns, HaveTheSettingsOfTheirCase) {
  const StudyFolder folder(two_cases);
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  const auto runs = experiment::plan_study(study, "out");
  EXPECT_THAT(experiment::sets_of(study, runs.front()), testing::IsEmpty());
  EXPECT_THAT(experiment::sets_of(study, runs.back()),
              testing::UnorderedElementsAre("physics.step_s=0.002", "name=fast"));
}

TEST(StudyRuns, TheHashOfTheInputsChangesWithSeedAndCaseOnly) {
  const StudyFolder folder(two_cases);
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  const auto runs = experiment::plan_study(study, "out");
  EXPECT_EQ(experiment::inputs_of(study, runs[0]),
            experiment::inputs_of(study, experiment::plan_study(study, "else")[0]));
  EXPECT_NE(experiment::inputs_of(study, runs[0]), experiment::inputs_of(study, runs[1]));
  EXPECT_NE(experiment::inputs_of(study, runs[0]), experiment::inputs_of(study, runs[2]));
}

TEST(StudyRuns, ACommandRepeatsARunAlone) {
  const StudyFolder folder(two_cases);
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  const std::string command = experiment::command_of(study, experiment::plan_study(study, "out").back());
  EXPECT_THAT(command, testing::AllOf(testing::StartsWith("shoal run "), testing::HasSubstr(" --seed 2"),
                                      testing::HasSubstr(" --set physics.step_s=0.002"),
                                      testing::EndsWith(" --bus none --no-serial-ports")));
}

TEST(StudyRuns, OneThatHasNotBeenRunSaysSo) {
  const StudyFolder folder(two_cases);
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  experiment::StudyRun run = experiment::plan_study(study, folder.folder.file("out"))[0];
  experiment::read_result(study, false, run);
  EXPECT_FALSE(run.record);
  EXPECT_EQ(run.failure, "it has not been run");
  EXPECT_FALSE(run.tried);
}

}  // namespace
