// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using experiment::csv_field;
using experiment::csv_fields;
using testing::ElementsAre;

TEST(Csv, AFieldIsInQuotesOnlyIfItMustBe) {
  EXPECT_EQ(csv_field("0.5 m"), "0.5 m");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("a \"b\""), "\"a \"\"b\"\"\"");
  EXPECT_EQ(csv_field("a\nb"), "\"a\nb\"");
  EXPECT_EQ(csv_field(""), "");
}

TEST(Csv, ALineIsSplitAtTheCommasOutsideOfQuotes) {
  EXPECT_THAT(*csv_fields("1,,\"a,b\",\"say \"\"no\"\"\",2"), ElementsAre("1", "", "a,b", "say \"no\"", "2"));
  EXPECT_THAT(*csv_fields(""), ElementsAre(""));
  EXPECT_THAT(*csv_fields("a,"), ElementsAre("a", ""));
  // A quote inside a field is only a character.
  EXPECT_THAT(*csv_fields("5\",x"), ElementsAre("5\"", "x"));
}

TEST(Csv, AnOpenQuoteIsNoLine) {
  EXPECT_FALSE(csv_fields("1,\"a,b"));
}

TEST(Csv, EveryFieldReadsAsItWasWritten) {
  for (const char* text : {"", "a", ",", "\"", "\"\"", "a,\"b\",", "'x'"}) {
    EXPECT_THAT(*csv_fields("0," + csv_field(text) + ",1"), ElementsAre("0", text, "1"));
  }
}

}  // namespace
