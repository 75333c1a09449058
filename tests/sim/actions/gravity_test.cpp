// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

TEST(Events, ChangeGravity) {
  test::TestWorld test(event_world("  - {name: a, at: 1, do: [{gravity_mps2: 2}]}\n"));
  test.run_for(1);
  EXPECT_EQ(test.world.find_object("ball")->base().v_WB_W().z(), 0);
  test.run_for(1);
  EXPECT_NEAR(test.world.find_object("ball")->base().v_WB_W().z(), -2, 1e-9);
}

}  // namespace
