// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "sim/director/script.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

TEST(Events, AddMoveAndRemoveObjects) {
  test::TestWorld test(
      event_world("  - {name: a, at: 0.1, do: [{add: crate}, {add: {object: {name: barrel, position_m: [1, 1, 1], "
                  "parts: [{shape: sphere, mass_kg: 2}]}}}]}\n"
                  "  - {name: b, at: 0.2, do: [{move: {name: crate, position_m: [4, 4, 4]}}, {remove: barrel}, "
                  "{remove: barrel}, {add: crate}]}\n"));
  EXPECT_EQ(test.world.find_object("crate"), nullptr);
  test.run_for(0.15);
  ASSERT_NE(test.world.find_object("crate"), nullptr);
  EXPECT_EQ(test.world.find_object("crate")->base().X_WB().translation().x(), 9);
  EXPECT_NE(test.world.find_object("barrel"), nullptr);
  test.run_for(0.15);
  EXPECT_EQ(test.world.find_object("crate")->base().X_WB().translation(), sim::Vector3d(4, 4, 4));
  EXPECT_EQ(test.world.find_object("barrel"), nullptr);
  // The second removal and the second crate fail, are reported and change nothing.
  EXPECT_EQ(test.world.counts().bad_messages, 2);
}

}  // namespace
