// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

/// Water with a current of 0.5 m/s to the east.
std::string sea(const test_support::ScratchFolder& folder) {
  std::ofstream(folder.file("sea.yaml"))
      << "shoal: 1\nmedium: {water: {surface_m: 1}, current: [{velocity_mps: [0.5, 0, 0]}]}\n";
  return folder.file("sea.yaml");
}

TEST(MediumCommand, ShowsTheWaterAtAPlace) {
  const test_support::ScratchFolder folder;
  const test::Called called = test::call_shoal({"medium", sea(folder), "--at", "1,2,-9"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_THAT(called.out, testing::AllOf(HasSubstr("10"), HasSubstr("0.5")));  // 10 m deep
}

TEST(MediumCommand, APlaceIsThreeNumbers) {
  const test_support::ScratchFolder folder;
  for (const char* at : {"1,2", "1,2,3,4", "1,2,x", "1,2,2e7", ""}) {
    const test::Called called = test::call_shoal({"medium", sea(folder), std::string("--at=") + at});
    EXPECT_EQ(called.exit_code, 2) << at;
    EXPECT_THAT(called.err, HasSubstr("--at")) << at;
  }
}

TEST(MediumCommand, AWorldWithoutWaterHasNoProfile) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("dry.yaml")) << "shoal: 1\n";
  const test::Called called = test::call_shoal({"medium", folder.file("dry.yaml"), "--at", "0,0,-1", "--profile"});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("--profile: this world has no water"));
}

}  // namespace
