// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/world_files/world_by_name.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "sim/config/diagnostics.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using experiment::ShippedKind;
namespace fs = std::filesystem;

std::string error_of(std::initializer_list<ShippedKind> kinds, const std::string& given) {
  try {
    experiment::file_by_name(kinds, given);
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(WorldByName, ShippedFilesHaveTheirNamesInOrder) {
  for (const ShippedKind kind : {ShippedKind::world, ShippedKind::vehicle, ShippedKind::study}) {
    const auto files = experiment::shipped_files(kind);
    EXPECT_FALSE(files.empty());
    EXPECT_TRUE(
        std::is_sorted(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.name < b.name; }));
    for (const experiment::ShippedFile& file : files) EXPECT_TRUE(fs::is_regular_file(file.path)) << file.path;
  }
}

TEST(WorldByName, AFileGoesBeforeAShippedOne) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("minimal.yaml")) << "shoal: 1\n";
  EXPECT_EQ(experiment::world_file(folder.file("minimal.yaml")), folder.file("minimal.yaml"));
  EXPECT_TRUE(fs::equivalent(experiment::world_file("minimal"), test_support::source_path("worlds/minimal.yaml")));
  EXPECT_TRUE(fs::equivalent(experiment::world_file("minimal.yaml"), test_support::source_path("worlds/minimal.yaml")));
}

TEST(WorldByName, AFolderOfResultsDoesNotHideTheWorldOfItsName) {
  const test_support::ScratchFolder folder;
  fs::create_directory(folder.file("minimal"));
  fs::create_directory(folder.file("no_world"));
  const fs::path before = fs::current_path();
  fs::current_path(folder.file(""));
  EXPECT_TRUE(fs::equivalent(experiment::world_file("minimal"), test_support::source_path("worlds/minimal.yaml")));
  EXPECT_EQ(experiment::world_file("no_world"), "no_world");
  fs::current_path(before);
}

TEST(WorldByName, APathThatIsNotThereIsLeftToItsReader) {
  EXPECT_EQ(experiment::world_file("nowhere/minimal.yaml"), "nowhere/minimal.yaml");
}

TEST(WorldByName, ANameThatNoFileHasIsAnErrorWithWhatWasMeant) {
  EXPECT_EQ(error_of({ShippedKind::world}, "minmal"),
            "'minmal': there is no such file here, nor 'minmal.yaml', nor a shipped world of this name; did you mean "
            "'minimal'?");
  EXPECT_THAT(error_of({ShippedKind::vehicle}, "minimal"), testing::EndsWith("'minimal' is a shipped world"));
  EXPECT_THAT(error_of({ShippedKind::world, ShippedKind::study}, "zzzzzzzz"),
              testing::EndsWith("nor a shipped world or study of this name; see `shoal list worlds` and `shoal list "
                                "studies`"));
}

}  // namespace
