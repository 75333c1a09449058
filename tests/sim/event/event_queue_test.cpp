// SPDX-License-Identifier: BSD-3-Clause
#include "sim/event/event_queue.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <set>

#include "sim/random/random.hpp"
#include "tests/state_hash_of.hpp"

namespace {

using sim::Event;
using sim::Time;

Event event_at(int due_us, int device) {
  Event event;
  event.due = Time{due_us};
  event.device = device;
  return event;
}

TEST(EventQueue, GivesEventsInTheOrderOfTheirTimesAndThenOfScheduling) {
  sim::EventQueue queue;
  for (const auto& [due, device] : {std::pair{30, 0}, {10, 1}, {20, 2}, {10, 3}, {10, 4}})
    queue.schedule(event_at(due, device));
  std::vector<int> order;
  for (Event event; queue.take_due(Time{25}, event);) order.push_back(event.device);
  EXPECT_EQ(order, (std::vector<int>{1, 3, 4, 2}));
  EXPECT_EQ(queue.size(), 1u);
}

/// Against a sorted list, with steps of all sizes, events near and far, with and without payloads, some scheduled while
/// others are taken, a device that goes, and restores in between.
TEST(EventQueue, GivesWhatASortedListGives) {
  sim::Random random(1, "events");
  random.begin_step(0);
  sim::EventQueue queue;
  std::map<std::pair<Time, int>, Event> expected;  // by time and number, which is the order of scheduling
  int number = 0;
  const auto schedule = [&](Time now) {
    const std::int64_t far_us = random.integer_below(10) == 0 ? 5'000'000 : 30'000;
    Event event = event_at(0, static_cast<int>(random.integer_below(4)));
    event.due = now + Time{static_cast<std::int64_t>(random.integer_below(static_cast<std::uint32_t>(far_us)))};
    event.kind = number;
    event.stamp = Time{7 * number};
    event.payload.resize(random.integer_below(3));
    expected.emplace(std::pair{event.due, number++}, event);
    queue.schedule(event);
  };
  for (Time now{0}; now < Time{3'000'000}; now += Time{1 + random.integer_below(60'000)}) {
    for (int i = 0; i < 20; ++i) schedule(now);
    int more = 5;
    for (Event event; queue.take_due(now, event);) {
      ASSERT_FALSE(expected.empty());
      const Event& next = expected.begin()->second;
      ASSERT_EQ(event.due, next.due);
      ASSERT_EQ(event.kind, next.kind);
      ASSERT_EQ(event.device, next.device);
      ASSERT_EQ(event.stamp, next.stamp);
      ASSERT_EQ(event.payload, next.payload);
      expected.erase(expected.begin());
      if (more-- > 0) schedule(event.due);
    }
    ASSERT_TRUE(expected.empty() || expected.begin()->first.first > now);
    ASSERT_EQ(queue.size(), expected.size());
    if (random.integer_below(10) == 0) {
      queue.drop_device(3);
      std::erase_if(expected, [](const auto& each) { return each.second.device == 3; });
    }
    if (random.integer_below(10) == 0) {
      sim::StateArchive saver = sim::StateArchive::saver();
      saver(queue);
      const sim::Bytes bytes = saver.take_bytes();
      sim::EventQueue restored;
      sim::StateArchive restorer = sim::StateArchive::restorer(bytes);
      restorer(restored);
      ASSERT_EQ(test::state_hash_of(restored), test::state_hash_of(queue));
      ASSERT_EQ(restored.content_hash(), queue.content_hash());
      queue = std::move(restored);
    }
  }
}

TEST(EventQueue, HashDependsOnWhatIsQueuedNotOnHowItCame) {
  sim::EventQueue first, second;
  first.schedule(event_at(10, 1));
  first.schedule(event_at(20, 2));
  second.schedule(event_at(20, 2));
  second.schedule(event_at(10, 1));
  EXPECT_EQ(test::state_hash_of(first), test::state_hash_of(second));
  second.schedule(event_at(30, 3));
  EXPECT_NE(test::state_hash_of(first), test::state_hash_of(second));
}

/// Of the content hash, which is kept up to date.
TEST(EventQueue, ContentHashDependsOnAllOfEachEvent) {
  sim::EventQueue queue;
  const auto with = [&](const Event& event) {
    queue.schedule(event);
    const std::uint64_t hash = queue.content_hash();
    queue.drop_device(event.device);
    return hash;
  };
  queue.schedule(event_at(10, 1));
  const std::uint64_t before = queue.content_hash();
  std::set<std::uint64_t> hashes{before};
  Event event = event_at(20, 2);
  EXPECT_TRUE(hashes.insert(with(event)).second);
  EXPECT_EQ(queue.content_hash(), before);
  event.due = Time{21};
  EXPECT_TRUE(hashes.insert(with(event)).second);
  event.kind = 5;
  EXPECT_TRUE(hashes.insert(with(event)).second);
  event.stamp = Time{6};
  EXPECT_TRUE(hashes.insert(with(event)).second);
  event.payload = sim::Bytes(3);
  EXPECT_TRUE(hashes.insert(with(event)).second);
  event.payload[1] = std::byte{1};
  EXPECT_TRUE(hashes.insert(with(event)).second);
  EXPECT_EQ(queue.content_hash(), before);
}

TEST(EventQueue, ContentHashChangesWhenTwoEventsExchangeTheirTimes) {
  sim::EventQueue first, second;
  first.schedule(event_at(10, 1));
  first.schedule(event_at(20, 2));
  second.schedule(event_at(20, 1));
  second.schedule(event_at(10, 2));
  EXPECT_NE(first.content_hash(), second.content_hash());
}

}  // namespace
