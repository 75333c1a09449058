// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/run_files.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "experiment/campaign/engines.hpp"
#include "experiment/campaign/manifest.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using test_support::ScratchFolder;

TEST(RunFiles, AHalfWrittenMarkIsNone) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  std::filesystem::create_directories(directory);
  EXPECT_FALSE(experiment::read_stamp(directory));
  experiment::write_stamp(directory, {"0123456789abcdef", "0.5 (x)"});
  ASSERT_TRUE(experiment::read_stamp(directory));
  EXPECT_EQ(experiment::read_stamp(directory)->inputs, "0123456789abcdef");
  EXPECT_EQ(experiment::read_stamp(directory)->version, "0.5 (x)");
  std::ofstream(directory + "/study_stamp.txt") << "inputs 0123456789abcdef\nshoal 0.5";
  EXPECT_FALSE(experiment::read_stamp(directory));
  experiment::write_failure(directory, {"0123456789abcdef", "two\nlines"});
  EXPECT_EQ(experiment::read_failure(directory)->reason, "two\nlines");
  experiment::StudyRun run;
  run.directory = directory;
  experiment::remove_marks(run);
  EXPECT_FALSE(experiment::read_failure(directory));
}

using test_support::ScratchFolder;

TEST(RunClaim, OnlyOneProcessHasAFolder) {
  const ScratchFolder folder;
  std::optional<experiment::RunClaim> first(std::in_place, folder.file(""), folder.file("run"));
  EXPECT_FALSE(first->owner());
  const experiment::RunClaim second(folder.file(""), folder.file("run"));
  EXPECT_TRUE(second.owner());
  first.reset();
  EXPECT_FALSE(experiment::RunClaim(folder.file(""), folder.file("run")).owner());
}

}  // namespace
