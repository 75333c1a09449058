// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/skill_array.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "tests/motion/formats/format_fixture.hpp"

namespace {

using testing::Contains;

constexpr double degree = std::numbers::pi / 180;

TEST(OpencatFormat, ChoosesOneOfTheSkillsOfAFile) {
  const std::string text =
      "#define BITTLE\n//number of skills: 2\nconst int8_t sit[] PROGMEM = { \n1, 0, -30, 1,\n"
      " 0,0,0,0, 0,0,0,0, 5,0,0,0, 0,0,0,0,\n};\n/* { */ const int8_t up[] PROGMEM = "
      "{1,0,0,1,0,0,0,0,0,0,0,0,30,30,30,30,30,30,30,30};\n"
      "const char* skillNameWithType[] = {\"sitI\", \"upN\"};\nconst char* const* progmemPointer[] = {sit, up};\n";
  EXPECT_EQ(test::read_error("opencat", text), "file: has several skills: choose one (--name) of sit, up");
  motion::FormatOptions options;
  options.name = "up";
  EXPECT_NEAR(test::value(test::read("opencat", text, {}, options).motion, "joint_15", 0), 30 * degree, 1e-12);
  options.name = "sit";
  EXPECT_THAT(test::read("opencat", text, {}, options).losses, Contains("the expected roll and pitch are not kept"));
}

TEST(OpencatFormat, ReadsNumbersAlone) {
  EXPECT_NEAR(
      test::value(test::read("opencat", "[1, 0, 0, 1, 0 0 0 0 0 0 0 0 7, 0 0 0 0 0 0 0]\n").motion, "joint_8", 0),
      7 * degree, 1e-12);
}

TEST(OpencatFormat, SaysWhereAndWhatIsWrong) {
  const auto error = [](const std::string& text) { return test::read_error("opencat", text); };
  EXPECT_EQ(error(""), "file:1:1: ends before the number of rows");
  EXPECT_EQ(error("1, 0, 0, 3"), "file:1:10: the ratio of angles must be 1 or 2, got 3");
  EXPECT_EQ(error("0, 0, 0, 1"), "file:1:1: the number of rows must not be 0");
  EXPECT_EQ(error("1, 0,\n 200"), "file:2:2: a number of a skill must be a whole number from -128 to 127, got '200'");
  EXPECT_EQ(error("const int8_t a[] = {1, x};"), "file:1:24: must be a number, got 'x'");
  EXPECT_EQ(error("const int8_t a[] = {1, 0, 0, 1};"), "file:1:20: skill 'a': 1 rows need 20 numbers, got 4");
  EXPECT_EQ(error("const int8_t a[] = {1, 0"), "file:1:1: the array must end with '}'");
  EXPECT_EQ(error("-1, 0, 0, 1, 0, 1, 0"), "file:1:17: a row of the loop must be from 0 to 0, got 1");
}

}  // namespace
