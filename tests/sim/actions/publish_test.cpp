// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/twist_command_t.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

TEST(Events, PublishWithTheTimeWhenNoneIsGiven) {
  test::TestWorld test(
      event_world("  - {name: a, at: 0.25, do: [{publish: {channel: cmd, type: shoal.twist_command_t, value: "
                  "{forward_mps: 1.5, turn_radps: -0.5}}}, {publish: {channel: cmd, type: shoal.twist_command_t, "
                  "value: {utime: 7}}}]}\n"));
  test::Listener<shoal::twist_command_t> commands(test, "cmd");
  test.run_for(1);
  const auto all = commands.take_all();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].utime, test.world.epoch_us() + 250000);
  EXPECT_EQ(all[0].forward_mps, 1.5);
  EXPECT_EQ(all[0].turn_radps, -0.5);
  EXPECT_EQ(all[1].utime, 7);
}

}  // namespace
