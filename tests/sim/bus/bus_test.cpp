// SPDX-License-Identifier: BSD-3-Clause
#include "sim/bus/bus.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace {

/// A bus that only keeps what is published.
class KeepingBus : public sim::Bus {
 public:
  void publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override {
    published.push_back(std::string(channel) + " " + std::to_string(payload.size()) + " at " +
                        std::to_string(at.count()));
  }
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string&, std::size_t) override { return nullptr; }
  sim::BusCounts counts() const override { return {}; }

  std::vector<std::string> published;
};

TEST(Bus, AnOpenChannelPublishesUnderItsNameWhereTheBusHasNoQuickerWay) {
  KeepingBus bus;
  const auto channel = bus.open_channel("rover.lidar");
  EXPECT_THAT(bus.published, testing::IsEmpty());
  const sim::Bytes payload(3);
  channel->publish(payload, sim::Time(5));
  channel->publish({}, sim::Time(7));
  EXPECT_THAT(bus.published, testing::ElementsAre("rover.lidar 3 at 5", "rover.lidar 0 at 7"));
}

}  // namespace
