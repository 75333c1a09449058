// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/joint_name.hpp"

#include <gtest/gtest.h>

namespace {

TEST(JointName, IsTextOfOneTo255Bytes) {
  for (const std::string& name : {std::string("hip"), std::string("linke Hüfte"), std::string(255, 'x')})
    EXPECT_EQ(sim::joint_name_error(name), "") << name;
  EXPECT_NE(sim::joint_name_error(std::string(256, 'x')), "");
  EXPECT_EQ(sim::joint_name_error(""),
            "the name of a joint must be UTF-8 text of 1 to 255 bytes without control characters, got ''");
}

TEST(JointName, HasNoControlCharactersAndNoBytesThatAreNoText) {
  EXPECT_EQ(sim::joint_name_error("hip\xe9"),
            "the name of a joint must be UTF-8 text of 1 to 255 bytes without control characters, got 'hip\\xe9'");
  for (const char* name : {"a\nb", "a\tb", "\x7f", "\x1b[31m"}) EXPECT_NE(sim::joint_name_error(name), "") << name;
}

}  // namespace
