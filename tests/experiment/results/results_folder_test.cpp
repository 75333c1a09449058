// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/results_folder.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "experiment/results/run_error.hpp"
#include "tests/scratch_folder.hpp"

namespace {

std::string error_of(const std::string& folder) {
  try {
    experiment::ResultsLock lock(folder);
  } catch (const experiment::RunError& error) {
    EXPECT_EQ(error.exit_code, 4);
    return error.what();
  }
  return "none";
}

TEST(ResultsLock, MakesTheFolderAndReleasesItAtItsEnd) {
  const test_support::ScratchFolder folder;
  EXPECT_EQ(error_of(folder.file("a/b")), "none");
  EXPECT_TRUE(std::filesystem::is_directory(folder.file("a/b")));
  EXPECT_EQ(error_of(folder.file("a/b")), "none");
}

TEST(ResultsLock, NamesWhoHoldsTheFolder) {
  const test_support::ScratchFolder folder;
  const experiment::ResultsLock lock(folder.file("results"));
  EXPECT_THAT(error_of(folder.file("results")),
              testing::AllOf(testing::HasSubstr(std::to_string(getpid())),
                             testing::EndsWith("is writing there; choose another folder with --results")));
}

TEST(ResultsLock, AFileIsNoFolder) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("results")) << "a file";
  EXPECT_THAT(error_of(folder.file("results")),
              testing::StartsWith("cannot write results to '" + folder.file("results") + "': "));
}

}  // namespace
