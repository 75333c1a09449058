// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/options/speed_option.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

namespace {

TEST(SpeedOption, IsAMultipleOfRealTimeOrTheMost) {
  EXPECT_EQ(tools::parse_speed("2.5"), 2.5);
  EXPECT_EQ(tools::parse_speed("0.001"), 0.001);
  EXPECT_EQ(tools::parse_speed("max"), 0);
  EXPECT_FALSE(tools::parse_speed(""));
}

TEST(SpeedOption, OtherTextsAreWrongUsage) {
  for (const char* text : {"0", "-1", "2e6", "fast", "2x", "nan", "Max"}) {
    try {
      tools::parse_speed(text);
      ADD_FAILURE() << text;
    } catch (const CLI::ValidationError& error) {
      EXPECT_STREQ(error.what(),
                   (std::string("--speed: must be from 0.001 to 1e6, or max, got '") + text + "'").c_str());
    }
  }
}

}  // namespace
