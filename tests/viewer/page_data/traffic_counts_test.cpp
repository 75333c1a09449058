// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/traffic_counts.hpp"

#include <gtest/gtest.h>

#include "tests/viewer/page_data/traffic_history_fixture.hpp"
#include "viewer/page_data/traffic_history.hpp"

namespace {

using namespace traffic_history_fixture;

TEST(TrafficCounts, SumBytesAndTimeOfEachSenderWithoutNoise) {
  viewer::TrafficCounts counts;
  for (int i = 0; i < 3; ++i) send(counts);
  send(counts, "noise");
  ASSERT_EQ(counts.senders().size(), 1u);
  const auto& [name, sender] = *counts.senders().begin();
  EXPECT_EQ(name, "a/modem");
  EXPECT_EQ(sender.count, 3);
  EXPECT_EQ(sender.bytes, 15);
  EXPECT_EQ(sender.sending_us, 1'200'000);
}

}  // namespace
