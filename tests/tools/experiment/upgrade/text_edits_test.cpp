// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/text_edits.hpp"

#include <gmock/gmock.h>

namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using tools::ChangedLines;
using tools::TextEdits;

TEST(TextEdits, AreAtBytesOfTheTextAsItWas) {
  TextEdits edits;
  edits.replace({4, 5}, "two");
  edits.insert(0, "> ");
  edits.erase({1, 2});
  EXPECT_EQ(edits.applied_to("a, b2c"), "> a btwoc");
}

TEST(TextEdits, InsertionsAtOnePlaceStayInTheirOrder) {
  TextEdits edits;
  edits.insert(1, "1");
  edits.insert(1, "2");
  EXPECT_EQ(edits.applied_to("ab"), "a12b");
}

TEST(TextEdits, ThatOverlapAreInDoubt) {
  TextEdits edits;
  edits.replace({0, 3}, "x");
  edits.insert(1, "y");
  EXPECT_THROW(edits.applied_to("abcd"), tools::Doubt);
}

TEST(TextEdits, ShowTheLinesThatChange) {
  const tools::SourceText text("a: 1\nb: 2\nc: 3\nd: 4\n");
  TextEdits edits;
  edits.replace({8, 9}, "5");
  edits.replace({18, 19}, "6\ne: 7");
  const std::vector<ChangedLines> lines = edits.changed_lines(text);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].first_line, 2);
  EXPECT_THAT(lines[0].before, ElementsAre("b: 2"));
  EXPECT_THAT(lines[0].after, ElementsAre("b: 5"));
  EXPECT_EQ(lines[1].first_line, 4);
  EXPECT_THAT(lines[1].before, ElementsAre("d: 4"));
  EXPECT_THAT(lines[1].after, ElementsAre("d: 6", "e: 7"));
}

TEST(TextEdits, ThatSpanLinesShowAllOfThem) {
  const tools::SourceText text("a:\n  b: 1\n  c: 2\nd: 4");
  TextEdits edits;
  edits.erase({2, 16});
  const std::vector<ChangedLines> lines = edits.changed_lines(text);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0].before, ElementsAre("a:", "  b: 1", "  c: 2"));
  EXPECT_THAT(lines[0].after, ElementsAre("a:"));
  EXPECT_THAT(TextEdits().changed_lines(text), IsEmpty());
}

}  // namespace
