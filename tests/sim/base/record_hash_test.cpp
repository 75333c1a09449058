// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/record_hash.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

TEST(RecordHash, EveryBitCounts) {
  std::uint64_t words[] = {1, 2, 3, 4};
  std::set<std::uint64_t> hashes{sim::record_hash(words)};
  for (int bit = 0; bit < 4 * 64; ++bit) {
    words[bit / 64] ^= std::uint64_t{1} << bit % 64;
    EXPECT_TRUE(hashes.insert(sim::record_hash(words)).second) << bit;
    words[bit / 64] ^= std::uint64_t{1} << bit % 64;
  }
}

TEST(RecordHash, SumChangesWhenRecordsExchangeWords) {
  const auto sum = [](std::uint64_t a, std::uint64_t b) {
    return sim::record_hash({1, 2, a, 4}) + sim::record_hash({5, 6, b, 8});
  };
  EXPECT_NE(sum(3, 7), sum(7, 3));
  const auto sum_of_pairs = [](std::uint64_t a, std::uint64_t b) {
    return sim::record_hash({1, 2, a, a + 1}) + sim::record_hash({5, 6, b, b + 1});
  };
  EXPECT_NE(sum_of_pairs(3, 7), sum_of_pairs(7, 3));
}

}  // namespace
