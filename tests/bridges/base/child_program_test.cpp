// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/base/child_program.hpp"

#include <gtest/gtest.h>

namespace {

TEST(ChildProgram, IsAnExecutableFileInPathOrAtItsPath) {
  EXPECT_TRUE(bridges::is_program("sh"));
  EXPECT_TRUE(bridges::is_program("/bin/sh"));
  EXPECT_FALSE(bridges::is_program("no-program-of-this-name"));
  EXPECT_FALSE(bridges::is_program("/bin")) << "a folder";
  EXPECT_FALSE(bridges::is_program("/etc/passwd")) << "not executable";
}

}  // namespace
