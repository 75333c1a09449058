// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/outgoing_queue.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bridges/bus/lcm_bus.hpp"
#include "bridges/lcm/lcm_listener.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace bridges;
using namespace std::chrono_literals;

constexpr sim::Time now{0};

TEST(OutgoingQueue, DropsTheOldestByNumberAndByBytes) {
  OutgoingQueue queue({.messages = 3, .bytes = 100, .wake_at = 256});
  for (const char* name : {"a", "b", "c", "d"}) queue.push(name, sim::Bytes(10));
  EXPECT_EQ(queue.dropped(), 1u);
  queue.push("e", sim::Bytes(85));  // 85 + 10 fit, 85 + 20 do not
  EXPECT_EQ(queue.dropped(), 3u);
  queue.close(std::chrono::steady_clock::now() + 10s);
  auto entry = queue.next(nullptr);
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->channel, "d");
  entry = queue.next(std::move(entry));
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->channel, "e");
  EXPECT_FALSE(queue.next(std::move(entry)));
}

TEST(OutgoingQueue, WhatIsLeftAtTheDeadlineIsCounted) {
  OutgoingQueue queue({});
  queue.push("a", sim::Bytes(1));
  queue.push("b", sim::Bytes(1));
  queue.close(std::chrono::steady_clock::now() - 1s);
  EXPECT_FALSE(queue.next(nullptr));
  EXPECT_EQ(queue.dropped(), 2u);
}

}  // namespace
