// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/line_difference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using experiment::line_difference;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(LineDifference, EqualTextsHaveNone) {
  EXPECT_THAT(line_difference("a\nb\n", "a\nb\n"), IsEmpty());
  EXPECT_THAT(line_difference("", ""), IsEmpty());
}

TEST(LineDifference, NamesTheLinesThatAreInOneTextAlone) {
  EXPECT_THAT(line_difference("a\nb\nc\nd\n", "a\nx\nc\nd\ne\n"),
              ElementsAre("-     2  b", "+     2  x", "+     5  e"));
}

TEST(LineDifference, StopsAtTheMost) {
  EXPECT_THAT(line_difference("1\n2\n3\n", "", 2), ElementsAre("-     1  1", "-     2  2", "and 1 more lines"));
}

}  // namespace
