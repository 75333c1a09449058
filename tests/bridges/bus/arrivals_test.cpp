// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/arrivals.hpp"

#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <thread>

#include "bridges/bus/lcm_bus.hpp"
#include "tests/bridges/bus/arrivals_fixture.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace arrivals_fixture;
using namespace bridges;
using namespace std::chrono_literals;

/// A bus that has got a message when its bell rings.
struct BellPort final : Arrivals::Port {
  explicit BellPort(Arrivals& all) : arrivals(all), place(all, *this, bell.fd()) {}
  void send_queued() override { ++asked_to_send; }
  bool receive() override {
    if (!bell.answer()) return alive;
    received_by = std::this_thread::get_id();
    if (received) arrivals.arrived();
    return alive;
  }

  Arrivals& arrivals;
  Bell bell;
  Arrivals::Place place;
  int asked_to_send = 0;
  std::thread::id received_by;
  bool received = true;  ///< someone subscribed to what comes
  bool alive = true;
};

TEST(Arrivals, WhoWaitsSendsAndReceivesForTheBuses) {
  Arrivals arrivals;
  BellPort one(arrivals), two(arrivals);
  two.bell.ring();
  EXPECT_TRUE(arrivals.wait(60s));
  EXPECT_EQ(two.received_by, std::this_thread::get_id());
  EXPECT_EQ(one.received_by, std::thread::id());
  EXPECT_EQ(one.asked_to_send, 1);
  EXPECT_EQ(two.asked_to_send, 1);
  EXPECT_FALSE(arrivals.wait(0ms));
}

TEST(Arrivals, AMessageThatNoOneWantsEndsNoWait) {
  Arrivals arrivals;
  BellPort port(arrivals);
  port.received = false;
  port.bell.ring();
  EXPECT_FALSE(arrivals.wait(1ms));
  EXPECT_EQ(port.received_by, std::this_thread::get_id());
}

TEST(Arrivals, AnotherThreadThatReceivesWakesWhoWaits) {
  Arrivals arrivals;
  std::thread other([&] { arrivals.arrived(); });
  EXPECT_TRUE(arrivals.wait(60s));
  other.join();
  EXPECT_FALSE(arrivals.wait(0ms));
}

TEST(Arrivals, NothingIsMissedWhileMessagesComeAllTheTime) {
  constexpr int messages = 50'000;
  Arrivals arrivals;
  std::atomic<int> sent = 0;
  std::thread other([&] {
    for (int i = 0; i < messages; ++i) {
      ++sent;
      arrivals.arrived();
    }
  });
  while (sent < messages) ASSERT_TRUE(arrivals.wait(60s) || sent == messages);
  other.join();
  arrivals.wait(0ms);
  EXPECT_FALSE(arrivals.wait(0ms));
}

TEST(Arrivals, ABusThatIsLostIsAskedNoMore) {
  Arrivals arrivals;
  BellPort port(arrivals);
  port.alive = false;
  port.bell.ring();
  EXPECT_TRUE(arrivals.wait(60s));
  port.received_by = {};
  port.bell.ring();
  EXPECT_FALSE(arrivals.wait(1ms));
  EXPECT_EQ(port.received_by, std::thread::id());
}

TEST(Arrivals, OneWaitServesSeveralBuses) {
  LcmBusOptions options;
  options.arrivals = std::make_shared<Arrivals>();
  LcmBus one(lcm_test::own_url(), options);
  LcmBus two("memq://", options);
  LcmBus far(lcm_test::own_url());
  const auto near_mailbox = one.open_mailbox("question");
  const auto far_mailbox = far.open_mailbox("answer");
  far.publish("question", lcm_test::bytes_of("?"), sim::Time{0});
  far.end_of_step();
  EXPECT_TRUE(two.wait_for_message(60s));
  EXPECT_TRUE(near_mailbox->take());
  one.publish("answer", lcm_test::bytes_of("!"), sim::Time{0});
  two.wait_for_message(0ms);  // sends for the other
  EXPECT_TRUE(far.wait_for_message(60s));
  EXPECT_TRUE(far_mailbox->take());
}

}  // namespace
