// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/lcm_listener.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bridges/bus/lcm_bus.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace bridges;

using lcm_test::bytes_of;
using lcm_test::own_url;

using namespace std::chrono_literals;

constexpr sim::Time now{0};

TEST(LcmListener, ReceivesAllChannelsInOrder) {
  LcmListener listener(own_url());
  listener.listen_to_all();
  LcmBus bus(own_url());
  // A hundred at once: the receive buffer of a stock kernel holds some 500, and what does not fit is lost.
  for (int begin = 0; begin < 500; begin += 100) {
    const auto channel = [begin](int i) { return "channel" + std::to_string(begin + i); };
    for (int i = 0; i < 100; ++i) bus.publish(channel(i), bytes_of(std::to_string(i)), now);
    bus.end_of_step();
    for (int i = 0; i < 100; ++i) {
      const auto message = listener.next(60s);
      ASSERT_TRUE(message);
      EXPECT_EQ(message->channel, channel(i));
      EXPECT_GT(message->wall_utime, 0);
    }
  }
  EXPECT_FALSE(listener.next(0ms));
}

TEST(LcmListener, MessagesThatHaveArrivedAreOneBatch) {
  LcmListener listener(own_url());
  listener.listen("a");
  int batches = 0;
  listener.take_in_batches([&] { ++batches; });
  LcmListener sender(own_url());
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(sender.publish("a", bytes_of(std::to_string(i))));
  for (int i = 0; i < 10; ++i) {
    const auto message = listener.next(60s);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->payload, bytes_of(std::to_string(i)));
  }
  EXPECT_EQ(batches, 1);  // before the first one; they were there already
  EXPECT_FALSE(listener.next(0ms));
  EXPECT_EQ(batches, 2);
}

TEST(LcmListener, RefusesWhatLcmCannotCarry) {
  LcmListener listener("memq://");
  EXPECT_FALSE(listener.publish("", bytes_of("x")));
  EXPECT_FALSE(listener.publish(std::string(64, 'a'), bytes_of("x")));
  EXPECT_TRUE(listener.publish("a", bytes_of("x")));
}

}  // namespace
