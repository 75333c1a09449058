// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/mute_bus.hpp"

#include <gtest/gtest.h>

#include "sim/bus/in_process_bus.hpp"

namespace {

TEST(MuteBus, LetsNothingThroughWhileItIsMuted) {
  sim::InProcessBus network;
  experiment::MuteBus bus(network);
  const auto inside = bus.open_mailbox("a");
  const auto outside = network.open_mailbox("a", 10);
  const sim::Bytes word(3, std::byte{1});
  bus.publish("a", word, sim::Time{0});
  EXPECT_TRUE(outside->take());
  EXPECT_TRUE(inside->take());

  bus.set_muted(true);
  bus.publish("a", word, sim::Time{0});
  EXPECT_FALSE(outside->take());
  network.publish("a", word, sim::Time{0});
  EXPECT_FALSE(inside->take());

  bus.set_muted(false);
  EXPECT_FALSE(inside->take()) << "what came meanwhile was kept";
  network.publish("a", word, sim::Time{0});
  EXPECT_TRUE(inside->take());
}

}  // namespace
