// SPDX-License-Identifier: BSD-3-Clause
#include "sim/bus/bus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "shoal/message_codec.hpp"
#include "shoal/utime_t.hpp"

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

TEST(UtimeStamp, IsThatOfTheEncodedMessage) {
  for (const std::int64_t utime : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1'700'000'000'123'456},
                                   std::numeric_limits<std::int64_t>::min()})
    EXPECT_EQ(sim::utime_of(shoal::encode(shoal::utime_t{utime})), utime);
}

TEST(UtimeStamp, IsReplacedAndNothingElse) {
  sim::Bytes payload = shoal::encode(shoal::utime_t{5});
  sim::set_utime(payload, -7);
  EXPECT_EQ(shoal::decode<shoal::utime_t>(payload, shoal::Finite::required).utime, -7);
  payload.push_back(std::byte{9});
  sim::set_utime(payload, 1);
  EXPECT_EQ(payload.back(), std::byte{9});
}

TEST(UtimeStamp, OfAMessageThatIsTooShortIsNone) {
  sim::Bytes payload = shoal::encode(shoal::utime_t{5});
  payload.pop_back();
  EXPECT_FALSE(sim::utime_of(payload));
  EXPECT_FALSE(sim::utime_of({}));
}

}  // namespace
