// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

TEST(Events, OfWeightZeroAreNeverChosen) {
  test::TestWorld test(event_world(
      "  - name: a\n    every: 0.01\n    do:\n      - one_of:\n          choices: [[{publish: {channel: tick, type: "
      "shoal.utime_t}}], [{end: no}]]\n          weights: [1, 0]\n"));
  EXPECT_EQ(ticks(test, 1.005).size(), 100u);
  EXPECT_FALSE(test.world.ended());
}

}  // namespace
