// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/line_reader.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "sim/config/diagnostics.hpp"

namespace {

using experiment::LineReader;
using experiment::Word;

template <typename Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "none";
}

std::vector<std::string> lines_of(const std::string& text) {
  LineReader reader(text, "f.csv");
  std::vector<std::string> lines;
  while (reader.next()) lines.push_back(std::to_string(reader.number()) + ":" + std::string(reader.line()));
  return lines;
}

TEST(LineReader, LinesEndAsInAnySystem) {
  EXPECT_THAT(lines_of("a\nb\r\n\nc"), testing::ElementsAre("1:a", "2:b", "3:", "4:c"));
  EXPECT_THAT(lines_of("\xef\xbb\xbf"
                       "a\n"),
              testing::ElementsAre("1:a"));
  EXPECT_THAT(lines_of(""), testing::IsEmpty());
}

/// Words as `text@column`.
std::vector<std::string> shown(const std::vector<Word>& words) {
  std::vector<std::string> all;
  for (const Word& word : words) all.push_back(std::string(word.text) + "@" + std::to_string(word.column));
  return all;
}

TEST(LineReader, WordsKnowTheirColumns) {
  LineReader reader("a, b ,,c\n  x\ty \n", "f.csv");
  ASSERT_TRUE(reader.next());
  EXPECT_THAT(shown(reader.split_at_commas()), testing::ElementsAre("a@1", "b@4", "@7", "c@8"));
  ASSERT_TRUE(reader.next());
  EXPECT_THAT(shown(reader.split_at_spaces()), testing::ElementsAre("x@3", "y@5"));
}

TEST(LineReader, ReadsNumbersWithinTheirLimits) {
  LineReader reader("1.5, +2, 1e3, x, +-1, 7, nan", "f.csv");
  ASSERT_TRUE(reader.next());
  const std::vector<Word> words = reader.split_at_commas();
  EXPECT_EQ(reader.number_of(words[0], 0, 10, "the range"), 1.5);
  EXPECT_EQ(reader.number_of(words[1], 0, 10, "the range"), 2);
  EXPECT_EQ(reader.whole_of(words[5], 0, 10, "the number"), 7);
  const auto error = [&](std::size_t word) {
    return error_of([&] { reader.number_of(words[word], 0, 10, "the range"); });
  };
  EXPECT_EQ(error(2), "f.csv:1:10: the range must be a number from 0 to 10, got '1e3'");
  EXPECT_EQ(error(3), "f.csv:1:15: the range must be a number from 0 to 10, got 'x'");
  EXPECT_NE(error(4), "none");
  EXPECT_NE(error(6), "none");
  EXPECT_EQ(error_of([&] { reader.whole_of(words[0], -3, 3, "the number"); }),
            "f.csv:1:1: the number must be a whole number from -3 to 3, got '1.5'");
}

TEST(LineReader, QuotesAreOfPrintableText) {
  EXPECT_EQ(experiment::text_in_quotes("caf\xe9"), "'caf\\xe9'");
  EXPECT_LT(experiment::text_in_quotes(std::string(10'000, 'x')).size(), 300u);
}

}  // namespace
