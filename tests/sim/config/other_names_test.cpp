// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "sim/config/message_text.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

TEST(OtherNames, OfOtherSimulatorsLeadToThoseOfShoal) {
  EXPECT_EQ(sim::synonym_of("revolute"), "hinge");
  EXPECT_EQ(sim::synonym_of("prismatic"), "slider");
  EXPECT_EQ(sim::synonym_of("laser"), "lidar");
  EXPECT_EQ(sim::synonym_of("xyz"), "position_m");
}

TEST(OtherNames, ThatNoOneHasAndThoseOfShoalLeadNowhere) {
  EXPECT_EQ(sim::synonym_of("hinge"), "");
  EXPECT_EQ(sim::synonym_of("Revolute"), "");
  EXPECT_EQ(sim::synonym_of(""), "");
}

TEST(OtherNames, AreWhatAnErrorProposes) {
  EXPECT_THAT(test::error_of_world(test::box_world("        - {name: a, type: laser}\n")),
              testing::HasSubstr("did you mean 'lidar'?"));
}

}  // namespace
