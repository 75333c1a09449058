// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

TEST(MeshCommand, SaysWhatIsNoMesh) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("text.stl")) << "no mesh";
  const test::Called called = test::call_shoal({"mesh", folder.file("text.stl")});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("mesh '" + folder.file("text.stl") + "'"));
}

TEST(MeshCommand, OptionsHaveTheirLimits) {
  EXPECT_THAT(test::call_shoal({"mesh"}).err, HasSubstr("FILE is required"));
  EXPECT_EQ(test::call_shoal({"mesh", "a.stl", "--scale", "0"}).exit_code, 2);
  EXPECT_EQ(test::call_shoal({"mesh", "a.stl", "--up", "sideways"}).exit_code, 2);
}

}  // namespace
