// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/text_layout.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace {

using namespace sim;

TEST(TextLayout, FillsLinesUpToTheWidthAndIndentsTheRest) {
  EXPECT_EQ(wrapped("one two three four", 9, 2), "one two\n  three\n  four");
  EXPECT_EQ(wrapped("one two", 7), "one two");  // exactly as wide
  EXPECT_EQ(wrapped("one two", 6), "one\ntwo");
  EXPECT_EQ(wrapped("", 10), "");
  EXPECT_EQ(wrapped("a_word_that_is_too_long b", 6), "a_word_that_is_too_long\nb");
}

TEST(TextLayout, CountsCharactersNotBytes) {
  EXPECT_EQ(column_count("Grüße"), 5u);
  EXPECT_EQ(wrapped("Grüße an", 8), "Grüße an");
  EXPECT_EQ(cut_to("Grüße an alle", 8), "Grüße...");
  EXPECT_EQ(cut_to("Grüße", 5), "Grüße");
}

TEST(TextLayout, PutsMeaningsBesideNamesAndBelowLongOnes) {
  EXPECT_EQ(two_columns({{"--a", "first"}, {"--bcd", "second third"}}, 18),
            "  --a    first\n  --bcd  second\n         third\n");
  EXPECT_EQ(two_columns({{"--a", "x"}, {"--far-too-long", "y"}}, 40, 6), "  --a  x\n  --far-too-long\n       y\n");
}

TEST(TextLayout, TakesTheWidthFromTheEnvironmentWhenItIsANumber) {
  const char* before = std::getenv("COLUMNS");
  const std::string kept = before == nullptr ? "" : before;
  for (const auto& [text, columns] : {std::pair{"100", 100}, {"20", 40}, {"99999", 1000}, {"wide", 80}, {"-3", 80}}) {
    setenv("COLUMNS", text, 1);
    EXPECT_EQ(text_columns(-1), columns) << text;
  }
  unsetenv("COLUMNS");
  EXPECT_EQ(text_columns(-1), 80);
  if (before != nullptr) setenv("COLUMNS", kept.c_str(), 1);
}

}  // namespace
