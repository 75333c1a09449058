// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

TEST(Events, EndTheRun) {
  test::TestWorld test(event_world("  - {name: a, at: 0.5, do: [{end: {reason: 'too late', passed: false}}]}\n"));
  test.run_for(1);
  ASSERT_TRUE(test.world.ended());
  EXPECT_EQ(test.world.ended()->text, "too late");
  EXPECT_FALSE(test.world.ended()->passed);
}

}  // namespace
