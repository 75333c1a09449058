// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/command_line/help.hpp"
#include "tools/command_line/parse.hpp"

namespace {

using namespace command_line;
using testing::ElementsAre;

TEST(Checks, SayRuleAndValue) {
  EXPECT_EQ(number_from(0, 1e9)("-1"), "must be from 0 to 1e9, got '-1'");
  for (const char* text : {"nan", "inf", "", "x", "1x", " 1"}) EXPECT_NE(number_from(0, 1e9)(text), "") << text;
  for (const char* text : {"0", "+1", "1e9", "1E3", ".5"}) EXPECT_EQ(number_from(0, 1e9)(text), "") << text;
  EXPECT_EQ(whole_from(1, 4)("2.5"), "must be a whole number from 1 to 4, got '2.5'");
  EXPECT_EQ(one_of({"lcm", "none"})("lmc"), "must be lcm or none, got 'lmc'; did you mean 'lcm'?");
  EXPECT_EQ(seed()("-1"), "must be a whole number from 0 to 9223372036854775807, got '-1'");
  EXPECT_EQ(setting()("=3"), "must be PATH=VALUE, such as run.seed=3, got '=3'");
}

TEST(Checks, NumbersAreReadByTheirSeparatorAndCount) {
  EXPECT_THAT(*numbers_in("100:5000:0.5", ':', 3), ElementsAre(100, 5000, 0.5));
  EXPECT_THAT(*numbers_in("-7", ',', 1), ElementsAre(-7));
  for (const char* text : {"", "1", "1,2", "1,2,3,4", "1,2,", ",1,2", "1,2,x", "1, 2,3", "1,2,inf", "1,nan,3", "1:2:3"})
    EXPECT_FALSE(numbers_in(text, ',', 3)) << text;
}

TEST(Checks, APointIsWithinTenThousandKilometers) {
  EXPECT_EQ(point_in("4,-3,2.5"), sim::Vector3d(4, -3, 2.5));
  EXPECT_EQ(point_in("1e7,0,-1e7"), sim::Vector3d(1e7, 0, -1e7));
  EXPECT_FALSE(point_in("1.01e7,0,0"));
  EXPECT_FALSE(point_in("1,2"));
}

TEST(Checks, PrintBoundsAsPeopleWriteThem) {
  EXPECT_EQ(bound_text(0), "0");
  EXPECT_EQ(bound_text(1e9), "1e9");
  EXPECT_EQ(bound_text(1e5), "100000");
  EXPECT_EQ(bound_text(1e12), "1e12");
  EXPECT_EQ(bound_text(1e-6), "1e-6");
  EXPECT_EQ(bound_text(-60), "-60");
}

}  // namespace
