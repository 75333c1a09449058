// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

TEST(RemoveAction, TakesAnObjectOrAVehicleAway) {
  test::TestWorld objects(event_world("  - {name: a, at: 0.1, do: [{remove: ball}]}\n"));
  objects.run_for(0.1);
  EXPECT_NE(objects.world.find_object("ball"), nullptr);
  objects.run_for(0.1);
  EXPECT_EQ(objects.world.find_object("ball"), nullptr);

  test::TestWorld vehicles(test::box_world("        - {name: imu, type: imu}\n", "{step_s: 0.01}",
                                           "events:\n  - {name: a, at: 0.1, do: [{remove: r1}]}\n"));
  vehicles.run_for(0.2);
  EXPECT_TRUE(vehicles.world.vehicles().empty());
}

TEST(RemoveAction, OfOneOfSeveralTakesOneAway) {
  test::TestWorld test(
      event_world("  - {name: b, at: 0, do: [{add: crate}]}\n"
                  "  - {name: a, at: 0.1, do: [{remove: {one_of: [ball, crate]}}]}\n"));
  test.run_for(0.2);
  EXPECT_EQ((test.world.find_object("ball") != nullptr) + (test.world.find_object("crate") != nullptr), 1);
}

TEST(RemoveAction, OfNothingThatTheFileKnowsIsAnError) {
  EXPECT_THAT(test::error_of_world(event_world("  - {name: a, at: 0, do: [{remove: bal}]}\n")),
              testing::HasSubstr("names no vehicle or object 'bal'; known vehicles or objects: ball, crate"));
}

}  // namespace
