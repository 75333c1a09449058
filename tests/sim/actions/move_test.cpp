// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;
using testing::HasSubstr;

std::string move(const std::string& keys) {
  return event_world("  - {name: a, at: 0.1, do: [{move: {" + keys + "}}]}\n");
}

TEST(MoveAction, PutsAnObjectSomewhereAtRest) {
  test::TestWorld test(
      event_world("  - {name: g, at: 0, do: [{gravity_mps2: 10}]}\n"
                  "  - {name: a, at: 0.1, do: [{gravity_mps2: 0}, {move: {name: ball, position_m: [1, 2, 3]}}]}\n"));
  test.run_for(0.1);
  EXPECT_LT(test.world.find_object("ball")->base().v_WB_W().z(), -0.8);
  test.run_for(0.02);
  EXPECT_TRUE(test.world.find_object("ball")->base().X_WB().translation().isApprox(sim::Vector3d(1, 2, 3)));
  EXPECT_EQ(test.world.find_object("ball")->base().v_WB_W().norm(), 0);
}

TEST(MoveAction, WhatIsNotGivenStaysAsItIs) {
  test::TestWorld test(move("name: ball, rpy_deg: [0, 0, 90]"));
  test.run_for(0.2);
  const sim::Pose X_WB = test.world.find_object("ball")->base().X_WB();
  EXPECT_TRUE(X_WB.translation().isApprox(sim::Vector3d(0, 0, 5)));
  EXPECT_NEAR(sim::yaw_of(X_WB.linear()), sim::degrees_to_radians(90), 1e-12);
}

TEST(MoveAction, NeedsAPlaceAndATarget) {
  EXPECT_THAT(test::error_of_world(move("name: ball")),
              HasSubstr("'move' needs a place: position_m, places, area_m, rpy_deg or random_yaw"));
  EXPECT_THAT(test::error_of_world(move("position_m: [0, 0, 0]")), HasSubstr("needs either 'name' or 'one_of'"));
}

TEST(MoveAction, OfWhatIsNotThereIsReportedAndChangesNothing) {
  test::TestWorld test(move("name: crate, position_m: [0, 0, 0]"));  // not present
  test.run_for(0.2);
  EXPECT_EQ(test.world.counts().bad_messages, 1);
  EXPECT_EQ(test.world.find_object("crate"), nullptr);
}

}  // namespace
