// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/run_identity.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "sim/world_file/load_world.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A list in which the file has a hash that is not its own.
std::string list_of(const std::string& path) {
  return std::string(16, '0') + " " + path + "\n";
}

TEST(RunIdentity, AFileThatIsAnotherOrMissingIsNamed) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("rock.stl");
  EXPECT_THAT(experiment::changed_files(list_of(path)), ElementsAre(path + ": is missing"));
  std::ofstream(path) << "solid";
  EXPECT_THAT(experiment::changed_files(list_of(path)), ElementsAre(path + ": is another file than in the run"));
}

TEST(RunIdentity, AFileThatCouldNotBeReadThenIsNotCompared) {
  EXPECT_THAT(experiment::changed_files(std::string(16, '-') + " /nowhere/rock.stl\n"), IsEmpty());
  EXPECT_THAT(experiment::changed_files("no such line\n\n"), IsEmpty());
}

TEST(RunIdentity, OnlyUnchangedFilesAreAllowed) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("rock.stl")) << "solid";
  sim::LoadOptions load;
  experiment::allow_files(
      list_of(folder.file("rock.stl")) + std::string(16, '-') + " " + folder.file("rock.stl") + "\n", load);
  EXPECT_THAT(load.allow_paths, IsEmpty());
}

TEST(RunIdentity, TheMachineIsItsProcessorAndLibrary) {
  EXPECT_THAT(experiment::build_text(), testing::HasSubstr(", glibc "));
}

}  // namespace
