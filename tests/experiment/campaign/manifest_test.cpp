// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/campaign/manifest.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <stdexcept>

#include "experiment/campaign/engines.hpp"
#include "experiment/study/run_files.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using test_support::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;

/// A study with two cases, a factor and two seeds: eight runs.
struct PlannedFolder {
  PlannedFolder() {
    write("small.yaml", test::rover_world("        - {name: lidar, type: lidar}\n", "", "",
                                          "metrics: [{name: e, type: position_error, vehicle: r1, channel: est}]\n"));
    write_study("seeds: [3, 4]\n");
    study = experiment::load_study(folder.file("study.yaml"));
    experiment::write_manifest(out(), study, experiment::plan_study(study, out()));
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder.file(name), std::ios::binary) << text;
  }
  void write_study(const std::string& more) const {
    write("study.yaml",
          "shoal: 1\nstudy: tiny\nworld: small.yaml\n"
          "cases: [{name: a}, {name: b, set: {physics.step_s: 0.002}}]\n"
          "factors: [{name: g, paths: [physics.gravity_mps2], values: [9.8, 1.6]}]\n" +
              more);
  }
  std::string out() const { return folder.file("out"); }
  std::string text() const {
    std::ifstream in(experiment::manifest_path(out()), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Error of reading the manifest after one of its texts was replaced.
  std::string error_after(const std::string& before, const std::string& after) const {
    std::string changed = text();
    const std::size_t at = changed.find(before);
    EXPECT_NE(at, std::string::npos) << before;
    changed.replace(at, before.size(), after);
    const std::string other = folder.file("other");
    std::filesystem::create_directories(other);
    std::ofstream(experiment::manifest_path(other), std::ios::binary) << changed;
    try {
      const experiment::Manifest manifest(other);
      for (std::size_t i = 1; i <= manifest.size(); ++i) manifest.run(i);
      experiment::PlannedStudy planned = experiment::load_planned(manifest, {});
      experiment::check_planned(manifest, planned, {0, 1, 2, 3, 4, 5, 6, 7});
      return {};
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }

  ScratchFolder folder;
  experiment::LoadedStudy study;
};

TEST(Manifest, KeepsTheAlgorithmsThatWereAdded) {
  PlannedFolder folder;
  folder.write("small.yaml", test::rover_world("        - {name: gps, type: gps}\n", "", "",
                                               "metrics: [{name: b, type: bound, vehicle: r1}]\n"));
  folder.write_study("seeds: [3, 4]\nlaunch: true\nalgorithms: [dr]\n");
  experiment::StudyChanges changes;
  changes.algorithms = {"ci"};
  try {
    folder.study = experiment::load_study(folder.folder.file("study.yaml"), changes);
  } catch (const std::exception& error) {
    FAIL() << error.what();
  }
  experiment::write_manifest(folder.out(), folder.study, experiment::plan_study(folder.study, folder.out()));
  const experiment::Manifest manifest(folder.out());
  EXPECT_THAT(manifest.algorithms(), ElementsAre("ci"));
  EXPECT_THAT(experiment::load_planned(manifest, {}).study.config.algorithms, ElementsAre("dr", "ci"));
  EXPECT_THAT(experiment::load_planned(manifest, {}, {"ci", "naive"}).study.config.algorithms,
              ElementsAre("dr", "ci", "naive"));
  EXPECT_THAT(folder.error_after("\"ci\"", "7"), HasSubstr("manifest.jsonl:1: 'algorithms' must be names"));
  EXPECT_THAT(folder.error_after("\"ci\"", "\"dr\""), HasSubstr("'algorithms': two algorithms have the name 'dr'"));
}

TEST(Manifest, ListsTheRunsInTheOrderOfCasesPointsAndSeeds) {
  const PlannedFolder folder;
  const experiment::Manifest manifest(folder.out());
  EXPECT_EQ(manifest.size(), 8u);
  EXPECT_THAT(manifest.seeds(), ElementsAre(3, 4));
  EXPECT_EQ(manifest.run(1).in_case, "a");
  EXPECT_EQ(manifest.run(2).seed, 4);
  EXPECT_EQ(manifest.run(3).point, 2u);
  EXPECT_EQ(manifest.run(8).in_case, "b");
  EXPECT_THAT(folder.text(), HasSubstr("{\"index\":8,\"case\":\"b\",\"point\":2,\"seed\":4,\"factors\":{\"g\":\"1.6\"},"
                                       "\"set\":[\"physics.step_s=0.002\",\"physics.gravity_mps2=1.6\"],\"inputs\":"));
  EXPECT_EQ(folder.error_after("", ""), "");
}

TEST(Manifest, ReportsWhatIsWrongWithItsLine) {
  const PlannedFolder folder;
  EXPECT_THAT(folder.error_after("{\"shoal_manifest\":1", "{\"shoal_manifest\":2"),
              HasSubstr("manifest.jsonl:1: 'shoal_manifest' must be 1, got 2"));
  EXPECT_THAT(folder.error_after("\"runs\":8", "\"runs\":9"), HasSubstr("a line for each of its 9 runs, got 8"));
  EXPECT_THAT(folder.error_after("\"runs\":8", "\"runs\":1e9"), HasSubstr("'runs' must be a whole number"));
  EXPECT_THAT(folder.error_after("[3,4]", "[3,3]"), HasSubstr(":1: 'seeds' must differ from each other"));
  EXPECT_THAT(folder.error_after("[3,4]", "[-3,4]"), HasSubstr(":1: a seed must be from 0 to 2^53, got -3"));
  EXPECT_THAT(folder.error_after("{\"index\":2", "{\"index\":3"),
              HasSubstr("manifest.jsonl:3: 'index' must be 2, got 3"));
  EXPECT_THAT(folder.error_after("{\"index\":2,", "{\"index\":2"), HasSubstr("manifest.jsonl:3: is not JSON"));
  EXPECT_THAT(folder.error_after("\"study\":\"/", "\"study\":\""), HasSubstr("'study' must be an absolute path"));
  EXPECT_THAT(folder.error_after("\"seed\":4", "\"seed\":5"), HasSubstr("run 2 is not as planned"));
  EXPECT_THAT(folder.error_after("\"case\":\"a\"", "\"case\":\"../b\""), HasSubstr("run 1 is not as planned"));
  std::ofstream(experiment::manifest_path(folder.out()), std::ios::app) << "{";
  EXPECT_THROW(experiment::Manifest{folder.out()}, std::runtime_error);
  EXPECT_THROW(experiment::Manifest{folder.folder.file("none")}, std::runtime_error);
}

TEST(Manifest, NoticesThatTheWorldHasChanged) {
  const PlannedFolder folder;
  const experiment::Manifest manifest(folder.out());
  folder.write("small.yaml",
               test::rover_world("        - {name: lidar, type: lidar, beams: 7}\n", "", "",
                                 "metrics: [{name: e, type: position_error, vehicle: r1, channel: est}]\n"));
  const experiment::PlannedStudy planned = experiment::load_planned(manifest, {});
  EXPECT_THROW(experiment::check_planned(manifest, planned, {0}), std::runtime_error);
  // What only changes the tables does not matter.
  const PlannedFolder other;
  const experiment::Manifest of_other(other.out());
  other.write_study("seeds: [1-9]\nfigures: [passed]\npass: [mean(a.passed) == 1]\n");
  EXPECT_NO_THROW(experiment::check_planned(of_other, experiment::load_planned(of_other, {}), {0, 7}));
}

TEST(Manifest, IndicesAreNumbersAndRanges) {
  EXPECT_THAT(experiment::parse_indices("3", 8), ElementsAre(2));
  EXPECT_THAT(experiment::parse_indices("7-8,1,1-2", 8), ElementsAre(0, 1, 6, 7));
  for (const char* wrong : {"", "0", "9", "1-9", "3-2", "x", "1,", "-1", "1-", "99999999999999999999"})
    EXPECT_THROW(experiment::parse_indices(wrong, 8), std::invalid_argument) << wrong;
  EXPECT_EQ(experiment::indices_text({0, 1, 2, 4, 6, 7}), "1-3,5,7-8");
  EXPECT_THAT(experiment::parse_indices("1-3,5,7-8", 8), ElementsAre(0, 1, 2, 4, 6, 7));
}

TEST(Manifest, ChunksHaveAllRunsOnce) {
  const auto chunks = experiment::chunks_of({1, 2, 3, 5, 8}, 2);
  EXPECT_THAT(chunks, ElementsAre(ElementsAre(1, 2), ElementsAre(3, 5), ElementsAre(8)));
}

}  // namespace
