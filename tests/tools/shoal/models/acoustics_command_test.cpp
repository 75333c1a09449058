// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

TEST(AcousticsCommand, NeedsWaterToCarrySound) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("dry.yaml")) << "shoal: 1\n";
  const test::Called called =
      test::call_shoal({"acoustics", folder.file("dry.yaml"), "--range", "100", "--depth", "10"});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("has no water to carry sound"));
}

TEST(AcousticsCommand, AnEndNeedsTheOther) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("sea.yaml")) << "shoal: 1\nmedium: {water: {}}\n";
  const test::Called called = test::call_shoal({"acoustics", folder.file("sea.yaml"), "--from", "0,0,-5"});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("--from: needs --to, and --to needs --from"));
}

}  // namespace
