// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/load_study.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "experiment/report/report_page.hpp"
#include "experiment/results/results.hpp"
#include "experiment/study/study_config.hpp"
#include "experiment/study/study_curves.hpp"
#include "experiment/study/study_results.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/experiment/study/study_folder.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using namespace study_folder;

using test_support::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(StudyConfig, CasesChangeTheWorld) {
  const StudyFolder folder(two_cases);
  const experiment::LoadedStudy study = experiment::load_study(folder.path());
  EXPECT_THAT(study.config.cases[1].sets(), ElementsAre("physics.step_s=0.002", "name=fast"));
  EXPECT_EQ(study.worlds[0].config.physics.step_s, 0.001);
  EXPECT_EQ(study.worlds[1].config.physics.step_s, 0.002);
  EXPECT_EQ(study.worlds[1].config.name, "fast");
}

TEST(StudyConfig, WorldIsAFileBesideItOrAShippedOneByName) {
  const ScratchFolder folder;
  const auto world_of = [&](const std::string& world) {
    write(folder.file("study.yaml"), "shoal: 1\nstudy: own\nworld: " + world + "\nseeds: [1]\n");
    return experiment::load_study(folder.file("study.yaml")).config.cases.front().world;
  };
  const std::string shipped =
      std::filesystem::path(test_support::source_path("worlds/minimal.yaml")).lexically_normal();
  EXPECT_EQ(world_of("minimal"), shipped);
  EXPECT_EQ(world_of("minimal.yaml"), shipped);
  std::filesystem::copy_file(shipped, folder.file("minimal.yaml"));
  EXPECT_EQ(world_of("minimal.yaml"), folder.file("minimal.yaml"));
  EXPECT_THROW(world_of("studies/coop_land.yaml"), sim::ConfigError);
}

TEST(StudyConfig, ThoseThatAreShippedCanBeRead) {
  int read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test_support::source_path("worlds/studies"))) {
    EXPECT_NO_THROW(experiment::load_study(entry.path().string())) << entry.path();
    ++read;
  }
  EXPECT_GT(read, 0);
}

TEST(StudyConfig, NamesNoOtherFilesThanItsWorldMay) {
  const std::string stone = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const ScratchFolder elsewhere;
  write(elsewhere.file("private.obj"), stone);
  const auto error_of = [&](const std::string& more) -> std::string {
    const StudyFolder study(more);
    write(study.folder.file("small.yaml"),
          "shoal: 1\nrun: {duration_s: 1}\n"
          "objects: [{name: o, fixed: true, parts: [{shape: mesh, mesh: own.obj}]}]\n");
    write(study.folder.file("own.obj"), stone);
    experiment::StudyChanges changes;
    changes.load.only_own_files = true;
    try {
      experiment::load_study(study.path(), changes);
      return "";
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  };
  const std::string mesh = "objects.o.parts.1.mesh", other = elsewhere.file("private.obj");
  const std::string rule = "'mesh' must lie below the folder of the world";
  EXPECT_EQ(error_of("cases: [{name: a, set: {" + mesh + ": own.obj}}]\n"), "");
  EXPECT_THAT(error_of("cases: [{name: a, set: {" + mesh + ": " + other + "}}]\n"), HasSubstr(rule));
  // Texts are all checked, not only the first ones.
  const auto factor = [&](const std::string& tenth) {
    std::string values = "own.obj";
    for (int i = 0; i < 8; ++i) values += ", ./" + std::string(static_cast<std::size_t>(i), '/') + "own.obj";
    return "factors: [{name: f, paths: [" + mesh + "], values: [" + values + ", " + tenth + ", ./././own.obj]}]\n";
  };
  EXPECT_EQ(error_of(factor("././own.obj")), "");
  EXPECT_THAT(error_of(factor(other)), HasSubstr(rule));
}

TEST(StudyConfig, ReportsWhatIsWrongWithASettingWhereItStands) {
  EXPECT_THAT(StudyFolder("cases:\n  - {name: a, set: {physics.step_s: -1}}\n").error(),
              HasSubstr("study.yaml:6:37: case 'a': 'physics.step_s': physics: 'step_s' must be"));
}

TEST(StudyConfig, WarnsOnceOfWhatIsWrongInAllCases) {
  const StudyFolder folder("cases: [{name: a}, {name: b}, {name: c}]\n");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  experiment::load_study(folder.path());
  const std::string log = testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
  const std::string warning = "nothing in this world publishes on 'est'";
  const std::size_t first = log.find(warning);
  ASSERT_NE(first, std::string::npos) << log;
  EXPECT_EQ(log.find(warning, first + 1), std::string::npos) << log;
}

}  // namespace
