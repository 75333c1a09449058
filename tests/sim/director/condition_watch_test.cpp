// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/condition_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/director/script.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

TEST(Events, ReceiveMessagesAndSeeTouches) {
  test::TestWorld received(event_world("  - {name: a, when: message on bell, " + tick));
  const auto mailbox = received.bus.open_mailbox("tick", 10);
  received.run_for(0.1);
  EXPECT_FALSE(mailbox->take());
  received.bus.publish("bell", {}, received.world.now());
  received.world.step();
  EXPECT_TRUE(mailbox->take());

  // The ball is 0.1 m above the table and falls: sqrt(2 * 0.1 / 9.80665) = 0.1428 s.
  test::TestWorld touch(
      event_world("  - {name: g, at: 0, do: [{gravity_mps2: 9.80665}]}\n  - {name: a, when: ball touches any, " + tick,
                  "  - {name: table, fixed: true, position_m: [0, 0, 4.3], parts: [{shape: box}]}\n"));
  const auto steps = ticks(touch, 1);
  ASSERT_FALSE(steps.empty());
  EXPECT_NEAR(static_cast<double>(steps.front()), 15, 1.5);
}

TEST(Events, DriveARoverThroughAZoneWithARecord) {
  test::TestWorld test(test::rover_world(drive) +
                       "zones:\n  - {name: slow, shape: box, position_m: [2, 0, 0], size_m: [2, 2, 2], "
                       "speed_limit_mps: 0.5}\n  - {name: goal, shape: sphere, position_m: [4, 0, 0], radius_m: 0.5, "
                       "finish: true}\nevents:\n" +
                       go + "  - {name: a, when: r1 inside slow, times: 1, do: [{log: here}]}\n" +
                       "  - {name: b, when: r1 faster than 0.5, " + tick);
  const auto mailbox = test.bus.open_mailbox("tick", 1000);
  test.run_for(6);
  EXPECT_TRUE(mailbox->take());
  EXPECT_FALSE(mailbox->take());  // it became faster once
  const sim::ZoneRecord& record = test.world.zone_records().at("r1");
  // 2 m at 1 m/s; and the goal begins at 3.5 m, which it reaches after a start of less than a second.
  EXPECT_NEAR(record.speeding_s, 2, 0.05);
  ASSERT_TRUE(record.finish_s);
  EXPECT_NEAR(*record.finish_s, 3.5, 1.0);
}

using namespace event_worlds;

/// Two balls that fall from 0.1 m onto a table.
std::string falling(const std::string& condition) {
  return "shoal: 1\nphysics: {step_s: 0.01}\ncontacts: [{between: [any, any], restitution: 0}]\nobjects:\n"
         "  - {name: ground, fixed: true, position_m: [0, 0, -5], parts: [{shape: plane}]}\n"
         "  - {name: table, fixed: true, position_m: [0, 0, -0.5], parts: [{shape: box, size_m: [9, 9, 1]}]}\n"
         "  - {name: a, position_m: [0, 0, 0.2], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}\n"
         "  - {name: b, position_m: [1, 0, 0.2], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}\n"
         "events:\n  - {name: touched, when: " +
         condition + ", " + tick;
}

std::size_t touches(const std::string& condition) {
  test::TestWorld test(falling(condition));
  return ticks(test, 1).size();
}

TEST(TouchWatch, CountsEachPairOnceWhileItTouches) {
  EXPECT_EQ(touches("a touches table"), 1u);
  EXPECT_EQ(touches("table touches a"), 1u);
  EXPECT_EQ(touches("a touches b"), 0u);
}

TEST(TouchWatch, AnyIsEverythingButPlanes) {
  EXPECT_EQ(touches("a touches any"), 1u);
  EXPECT_EQ(touches("ground touches any"), 0u);
}

TEST(TouchWatch, ANewObjectOfTheSameNameTouchesAnew) {
  test::TestWorld test(falling("a touches table") +
                       "  - {name: gone, at: 0.5, do: [{remove: a}]}\n"
                       "  - {name: back, at: 0.6, do: [{add: a}]}\n");
  EXPECT_EQ(ticks(test, 1).size(), 2u);
}

}  // namespace
