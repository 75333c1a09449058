#include "sim/world/event_queue.hpp"

#include <gtest/gtest.h>

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

}  // namespace
