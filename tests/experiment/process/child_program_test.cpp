// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/child_program.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

namespace {

TEST(ShellWord, IsQuotedOnlyWhereItMustBe) {
  EXPECT_EQ(experiment::shell_word("run.seed=3"), "run.seed=3");
  EXPECT_EQ(experiment::shell_word("udpm://1:2,+"), "udpm://1:2,+");
  EXPECT_EQ(experiment::shell_word("two words"), "'two words'");
  EXPECT_EQ(experiment::shell_word(""), "''");
  EXPECT_EQ(experiment::shell_word("it's"), R"('it'\''s')");
}

TEST(ShellWord, IsThatWordToAShell) {
  for (const std::string& word :
       {std::string("$HOME * ? [a] `id`"), std::string("it's \"quoted\" \\ #"), std::string("~;|&<>(){}!")}) {
    FILE* const shell = popen(("printf %s " + experiment::shell_word(word)).c_str(), "r");
    ASSERT_NE(shell, nullptr);
    std::array<char, 200> text{};
    const std::size_t size = std::fread(text.data(), 1, text.size(), shell);
    pclose(shell);
    EXPECT_EQ(std::string(text.data(), size), word);
  }
}

}  // namespace
