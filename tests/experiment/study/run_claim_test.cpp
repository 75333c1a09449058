// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/run_claim.hpp"

#include <gmock/gmock.h>

#include "experiment/campaign/engines.hpp"
#include "experiment/campaign/manifest.hpp"
#include "experiment/study/run_files.hpp"
#include "tests/scratch_folder.hpp"

namespace {

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
