// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/param_info.hpp"

#include <gmock/gmock.h>

#include "sim/config/param_reader.hpp"
#include "tests/sim/config/param_reader_fixture.hpp"

namespace {

using namespace param_reader_fixture;

TEST(Rule, SaysWhatItAllows) {
  EXPECT_EQ(sim::any_number().text(), "");
  EXPECT_EQ(sim::at_least(1).text(), ">= 1");
  EXPECT_EQ(sim::above(0).text(), "> 0");
  EXPECT_EQ(sim::at_most(100000).text(), "<= 100000");
  EXPECT_EQ(sim::between(0, 360).text(), ">= 0 and <= 360");
  EXPECT_EQ(sim::above_to(0, 0.5).text(), "> 0 and <= 0.5");
  EXPECT_EQ(sim::between(1, 1).text(), "1");
}

TEST(Rule, AllowsItsEndsUnlessTheyAreOpen) {
  EXPECT_TRUE(sim::at_least(1).allows(1));
  EXPECT_FALSE(sim::above(1).allows(1));
  EXPECT_TRUE(sim::at_most(1).allows(1));
  EXPECT_FALSE(sim::above_to(0, 1).allows(0));
  EXPECT_TRUE(sim::above_to(0, 1).allows(1));
  EXPECT_FALSE(sim::between(0, 1).allows(1.5));
}

}  // namespace
