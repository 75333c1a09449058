// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/traffic_history.hpp"

#include <gtest/gtest.h>

#include "tests/viewer/page_data/traffic_history_fixture.hpp"

namespace {

using namespace traffic_history_fixture;

TEST(TrafficHistory, ARewindGivesTheCountsOfThen) {
  viewer::TrafficCounts counts;
  viewer::TrafficHistory history;
  for (int second = 1; second <= 10; ++second) {
    send(counts);
    history.mark(second * 1'000'000, 0, counts);
  }
  EXPECT_TRUE(history.rewind(4'500'000));
  const viewer::TrafficCounts then = history.last();
  EXPECT_EQ(then.channels().at("sim.sound").count, 4);
  EXPECT_EQ(then.senders().at("a/modem").sending_us, 1'600'000);
  EXPECT_EQ(then.sent({"a/modem", "b/modem"}), 4);
  EXPECT_FALSE(history.rewind(4'500'000));
}

/// Each mark has six values: count and bytes of the channel, messages to all, and count, bytes and time of the sender.
/// So there is room for 100 marks; those of the older half are some 100 to 200 s apart.
TEST(TrafficHistory, KeepsMarksOfLongAgoFartherApart) {
  viewer::TrafficCounts counts;
  viewer::TrafficHistory history(600);
  constexpr int seconds = 5000;
  for (int second = 1; second <= seconds; ++second) {
    send(counts);
    history.mark(second * 1'000'000LL, 0, counts);
  }
  const auto count_at = [&](int second) {
    viewer::TrafficHistory copy = history;
    copy.rewind(second * 1'000'000LL);
    return copy.last().channels().contains("sim.sound") ? copy.last().channels().at("sim.sound").count : 0;
  };
  for (const int second : {seconds, seconds - 1, seconds - 10}) EXPECT_EQ(count_at(second), second);
  for (int second = 100; second < seconds; second += 100) {
    EXPECT_LE(count_at(second), second);
    EXPECT_GE(count_at(second), second - seconds / 8);
  }
}

}  // namespace
