// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/tap_bus.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "sim/bus/in_process_bus.hpp"

namespace {

TEST(TapBus, PassesWhatIsPublishedOnToItsListenerAndTheBus) {
  sim::InProcessBus inner;
  std::vector<std::string> heard;
  experiment::TapBus bus(inner, [&](std::string_view channel, std::span<const std::byte> payload, sim::Time at) {
    heard.push_back(std::string(channel) + " " + std::to_string(payload.size()) + " " + std::to_string(at.count()));
  });
  const auto mailbox = bus.open_mailbox("a");
  const auto channel = bus.open_channel("a");
  bus.publish("a", sim::Bytes(1), sim::Time{10});
  channel->publish(sim::Bytes(2), sim::Time{20});
  inner.publish("a", sim::Bytes(3), sim::Time{30});
  EXPECT_THAT(heard, testing::ElementsAre("a 1 10", "a 2 20")) << "not what comes from the bus";
  for (const std::size_t size : {1u, 2u, 3u}) {
    const auto message = mailbox->take();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->payload.size(), size);
  }
}

}  // namespace
