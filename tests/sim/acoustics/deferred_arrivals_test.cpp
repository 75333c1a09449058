// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/deferred_arrivals.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using sim::AcousticEvent;
using sim::ArrivalEffects;
using sim::FlightId;
using sim::Time;

/// What was handled and applied, as "flight@time".
struct Handled {
  std::vector<std::string> handled;
  std::vector<int> applied;
  /// A `near` of flight 0 lets it start at 30.
  void run(sim::DeferredArrivals& deferred, Time until) {
    deferred.handle(
        until, nullptr,
        [&](FlightId flight, AcousticEvent kind, Time due, ArrivalEffects& effects) {
          handled.push_back(std::to_string(flight.number) + "@" + std::to_string(due.count()));
          if (kind == AcousticEvent::near) effects.schedule(Time{30}, AcousticEvent::start);
          if (kind == AcousticEvent::start) effects.schedule(Time{99}, AcousticEvent::end);
        },
        [&](FlightId flight, const ArrivalEffects& effects) {
          applied.push_back(flight.number);
          for (int i = 0; i < effects.count; ++i)
            handled.push_back("later " + std::to_string(effects.events[static_cast<std::size_t>(i)].at.count()));
        });
  }
};

TEST(DeferredArrivals, AreHandledByReceiverAndAppliedInTheirOrder) {
  sim::DeferredArrivals deferred;
  deferred.add({1}, AcousticEvent::end, Time{10}, 5);
  deferred.add({2}, AcousticEvent::end, Time{20}, -1);
  deferred.add({3}, AcousticEvent::end, Time{30}, 5);
  Handled all;
  all.run(deferred, Time{100});
  EXPECT_EQ(all.handled, (std::vector<std::string>{"1@10", "3@30", "2@20"}));
  EXPECT_EQ(all.applied, (std::vector<int>{1, 2, 3}));
  EXPECT_TRUE(deferred.empty());
  EXPECT_EQ(deferred.handled(), 3);
}

TEST(DeferredArrivals, AStartThatFollowsIsHandledAtItsTime) {
  sim::DeferredArrivals deferred;
  deferred.add({0}, AcousticEvent::near, Time{10}, 1);
  deferred.add({1}, AcousticEvent::end, Time{20}, 1);
  deferred.add({2}, AcousticEvent::end, Time{30}, 1);
  deferred.add({3}, AcousticEvent::end, Time{40}, 1);
  Handled all;
  all.run(deferred, Time{100});
  // At the same time that which was scheduled earlier comes first.
  EXPECT_EQ(all.handled, (std::vector<std::string>{"0@10", "1@20", "2@30", "0@30", "3@40", "later 99"}));
}

TEST(DeferredArrivals, AStartAfterTheLimitWaits) {
  sim::DeferredArrivals deferred;
  deferred.add({0}, AcousticEvent::near, Time{10}, 1);
  Handled all;
  all.run(deferred, Time{30});
  EXPECT_EQ(all.handled, (std::vector<std::string>{"0@10", "later 30"}));
}

TEST(DeferredArrivals, ClearedOnesAreNotHandled) {
  sim::DeferredArrivals deferred;
  deferred.add({0}, AcousticEvent::end, Time{10}, 1);
  deferred.clear();
  EXPECT_TRUE(deferred.empty());
  deferred.add({1}, AcousticEvent::end, Time{20}, 1);
  Handled all;
  all.run(deferred, Time{100});
  EXPECT_EQ(all.handled, (std::vector<std::string>{"1@20"}));
}

}  // namespace
