// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/child_program.hpp"

#include <gtest/gtest.h>

namespace {

TEST(ChildProgram, IsAnExecutableFileInPathOrAtItsPath) {
  EXPECT_TRUE(experiment::is_program("sh"));
  EXPECT_TRUE(experiment::is_program("/bin/sh"));
  EXPECT_FALSE(experiment::is_program("no-program-of-this-name"));
  EXPECT_FALSE(experiment::is_program("/bin")) << "a folder";
  EXPECT_FALSE(experiment::is_program("/etc/passwd")) << "not executable";
}

}  // namespace
