// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using command_line::numbers_in;
using command_line::point_in;
using testing::ElementsAre;

/// Returns what a validator says of a text; empty: it accepts it.
std::string verdict(const CLI::Validator& check, std::string text) {
  return check(text);
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

TEST(Checks, ANumberOutOfRangeIsNamedWithItsRule) {
  const CLI::Validator check = command_line::number_from(-1, 2.5);
  EXPECT_EQ(verdict(check, "2.5"), "");
  EXPECT_EQ(verdict(check, "+1"), "");
  EXPECT_THAT(verdict(check, "2.6"), testing::AllOf(testing::HasSubstr("from -1 to 2.5"), testing::HasSubstr("'2.6'")));
  EXPECT_NE(verdict(check, "nan"), "");
  EXPECT_NE(verdict(check, "1x"), "");
}

TEST(Checks, AWholeNumberHasNoFraction) {
  const CLI::Validator check = command_line::whole_from(1, 4);
  EXPECT_EQ(verdict(check, "4"), "");
  for (const char* text : {"0", "5", "1.5", "", "two"}) EXPECT_NE(verdict(check, text), "") << text;
}

TEST(Checks, ASeedIsAWholeNumberThatFits63Bits) {
  EXPECT_EQ(verdict(command_line::seed(), "9223372036854775807"), "");
  EXPECT_NE(verdict(command_line::seed(), "9223372036854775808"), "");
  EXPECT_NE(verdict(command_line::seed(), "-1"), "");
}

TEST(Checks, AWordMustBeOneOfTheList) {
  const CLI::Validator check = command_line::one_of({"lcm", "none"});
  EXPECT_EQ(verdict(check, "none"), "");
  EXPECT_THAT(verdict(check, "udp"), testing::HasSubstr("'udp'"));
}

}  // namespace
