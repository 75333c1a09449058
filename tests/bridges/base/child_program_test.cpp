// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/base/child_program.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

namespace {

TEST(ShellWord, IsQuotedOnlyWhereItMustBe) {
  EXPECT_EQ(bridges::shell_word("run.seed=3"), "run.seed=3");
  EXPECT_EQ(bridges::shell_word("udpm://1:2,+"), "udpm://1:2,+");
  EXPECT_EQ(bridges::shell_word("two words"), "'two words'");
  EXPECT_EQ(bridges::shell_word(""), "''");
  EXPECT_EQ(bridges::shell_word("it's"), R"('it'\''s')");
}

TEST(ShellWord, IsThatWordToAShell) {
  for (const std::string& word :
       {std::string("$HOME * ? [a] `id`"), std::string("it's \"quoted\" \\ #"), std::string("~;|&<>(){}!")}) {
    FILE* const shell = popen(("printf %s " + bridges::shell_word(word)).c_str(), "r");
    ASSERT_NE(shell, nullptr);
    std::array<char, 200> text{};
    const std::size_t size = std::fread(text.data(), 1, text.size(), shell);
    pclose(shell);
    EXPECT_EQ(std::string(text.data(), size), word);
  }
}

TEST(ChildProgram, IsAnExecutableFileInPathOrAtItsPath) {
  EXPECT_TRUE(bridges::is_program("sh"));
  EXPECT_TRUE(bridges::is_program("/bin/sh"));
  EXPECT_FALSE(bridges::is_program("no-program-of-this-name"));
  EXPECT_FALSE(bridges::is_program("/bin")) << "a folder";
  EXPECT_FALSE(bridges::is_program("/etc/passwd")) << "not executable";
}

}  // namespace
