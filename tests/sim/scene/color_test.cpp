// SPDX-License-Identifier: BSD-3-Clause
#include "sim/scene/color.hpp"

#include <gtest/gtest.h>

namespace {

TEST(Color, HasTwoHexadecimalDigitsForEachPart) {
  EXPECT_EQ(sim::parse_color("#0a80ff"), (sim::Color{10, 128, 255}));
  EXPECT_EQ(sim::parse_color("#FFffFf"), (sim::Color{255, 255, 255}));
}

TEST(Color, OtherTextsAreNone) {
  for (const char* text : {"", "#", "0a80ff", "#0a80f", "#0a80ff0", "#0a80fg", "#+a80ff", "# a80ff", "#-180ff", "red"})
    EXPECT_FALSE(sim::parse_color(text)) << text;
}

}  // namespace
