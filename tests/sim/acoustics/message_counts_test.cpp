// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/message_counts.hpp"

#include <gtest/gtest.h>

namespace {

TEST(MessageCounts, AnAddressGetsItsOwnMessagesAndThoseToItsGroup) {
  sim::MessageCounts counts;
  counts.count({"modems", "a"});
  counts.count({"modems", "a"});
  counts.count({"modems", ""});
  counts.count({"others", "a"});
  EXPECT_EQ(counts.sent_to({"modems", "a"}), 3);
  EXPECT_EQ(counts.sent_to({"modems", "b"}), 1);
  EXPECT_EQ(counts.sent_to({"modems", ""}), 1) << "without an address: broadcasts only";
  EXPECT_EQ(counts.sent_to({"third", "a"}), 0);
}

TEST(MessageCounts, ADiscardedAddressKeepsTheMessagesToItsGroup) {
  sim::MessageCounts counts;
  counts.count({"modems", "a"});
  counts.count({"modems", ""});
  counts.discard({"modems", "a"});
  EXPECT_EQ(counts.sent_to({"modems", "a"}), 1);
  counts.discard({"modems", ""});
  counts.discard({"third", "a"});
  EXPECT_EQ(counts.sent_to({"modems", "a"}), 1);
}

}  // namespace
