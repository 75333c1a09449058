// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/standalone_world.hpp"

#include <gtest/gtest.h>

#include "sim/world/world_state.hpp"
#include "sim/world_file/load_world.hpp"

namespace {

TEST(StandaloneWorld, IsTheWorldOfItsConfigurationWithABusOfItsOwn) {
  const sim::LoadedWorld loaded = sim::load_world_text(
      "shoal: 1\nphysics: {step_s: 0.01}\nobjects:\n"
      "  - {name: crate, position_m: [0, 0, 100], parts: [{shape: box, mass_kg: 5}]}\n",
      "well.yaml", {});
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  sim::StandaloneWorld standalone(loaded.config);
  const auto mailbox = standalone.own_bus.open_mailbox("a", 1);
  for (int i = 0; i < 10; ++i) {
    world.step();
    standalone.step();
  }
  EXPECT_EQ(standalone.state().run_hash(), world.state().run_hash());
  standalone.bus().publish("a", sim::Bytes(3), standalone.now());
  EXPECT_TRUE(mailbox->take());
}

}  // namespace
