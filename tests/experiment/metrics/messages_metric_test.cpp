// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "messages/yaml/message_writer.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/experiment/score/metric_worlds.hpp"

namespace {

using namespace metric_worlds;

TEST(Messages, AreCountedWithTheirBytes) {
  MetricWorld world("  - {name: m, type: messages, channel: hello, from_s: 0.2}\n");
  world.run_for(0.1);
  world.test.send("hello", shoal::twist_command_t{});
  world.run_for(0.2);
  world.test.send("hello", shoal::twist_command_t{});
  world.test.bus.publish("hello", sim::Bytes(5), world.test.world.now());
  world.run_for(0.01);
  EXPECT_EQ(world.figure("m.count"), 2);
  EXPECT_EQ(world.figure("m.bytes"), 5 + static_cast<double>(shoal::encode(shoal::twist_command_t{}).size()));
  EXPECT_NEAR(world.figure("m.first_s"), 0.301, 1e-9);
}

}  // namespace
