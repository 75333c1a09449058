// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

using testing::ElementsAre;

TEST(Events, TriggerEachOtherInTheSameStep) {
  test::TestWorld test(
      event_world("  - {name: a, at: 0.1, do: [{trigger: b}]}\n  - {name: b, do: [{log: b}]}\n"
                  "  - {name: c, when: event b fires, " +
                  tick));
  EXPECT_THAT(ticks(test, 1), ElementsAre(10));
}

TEST(Events, ThatTriggerEachOtherForEverAreCutAndTheRunContinues) {
  test::TestWorld test(
      event_world("  - {name: a, at: 0.1, do: [{trigger: b}]}\n"
                  "  - {name: b, do: [{trigger: a}, {trigger: b}, {trigger: b}]}\n"
                  "  - {name: late, at: 0.2, " +
                  tick));
  // `a` has fired its one time; `b` fires itself twice: 100 deep, and no more than 1000 in all.
  EXPECT_THAT(ticks(test, 1), ElementsAre(20));
  EXPECT_EQ(test.world.counts().bad_messages, 1);
}

}  // namespace
