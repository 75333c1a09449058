// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/file_kind.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "sim/config/diagnostics.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/config/parse.hpp"

namespace {

using sim::FileKind;

TEST(FileKind, IsThatOfTheKeysOfTheTopLevel) {
  const auto kind = [](const std::string& yaml) { return sim::kind_of_file(test::parse(yaml)); };
  EXPECT_EQ(kind("{shoal: 1, vehicles: [], bodies: []}"), FileKind::world);
  EXPECT_EQ(kind("{shoal: 1, vehicle: rover}"), FileKind::vehicle);
  EXPECT_EQ(kind("{shoal: 1, bodies: []}"), FileKind::vehicle);
  EXPECT_EQ(kind("{study: s}"), FileKind::study);
  EXPECT_EQ(kind("{cases: [], world: w}"), FileKind::study);
  EXPECT_EQ(kind("{cases: []}"), FileKind::world);
  EXPECT_EQ(kind("{motion: wave}"), FileKind::motion);
  EXPECT_EQ(kind("{keys: [], poses: []}"), FileKind::motion);
  EXPECT_EQ(kind("{shoal_args: 1, vehicle: x}"), FileKind::declaration);
  EXPECT_EQ(kind("{}"), FileKind::world);
}

TEST(FileKind, AnotherKindIsAnErrorWithWhatToDoWithIt) {
  const auto error = [](const std::string& yaml, FileKind expected) -> std::string {
    try {
      sim::require_file_kind(test::parse(yaml), expected, {});
    } catch (const sim::ConfigError& found) {
      return found.what();
    }
    return "none";
  };
  EXPECT_NE(error("{study: s}", FileKind::world).find("this is a study, not a world; `shoal study FILE` runs it"),
            std::string::npos);
  EXPECT_NE(error("{vehicles: []}", FileKind::vehicle).find("this is a world, not a vehicle; `shoal run FILE` runs it"),
            std::string::npos);
  EXPECT_EQ(error("{vehicles: []}", FileKind::world), "none");
  EXPECT_EQ(error("{}", FileKind::study), "none");  // a study whose keys are missing
}

TEST(FileKind, OfAFileIsReadWithoutItsIncludes) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("rover.yaml")) << "include: nowhere.yaml\nvehicle: rover\n";
  EXPECT_EQ(sim::other_kind(folder.file("rover.yaml"), FileKind::world), "a vehicle, not a world");
  EXPECT_EQ(sim::other_kind(folder.file("rover.yaml"), FileKind::vehicle), "");
  EXPECT_EQ(sim::other_kind(folder.file("missing.yaml"), FileKind::world), "");
  EXPECT_EQ(sim::other_kind(folder.file(""), FileKind::world), "");
}

}  // namespace
