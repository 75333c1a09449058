// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/state_hash.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace {

std::uint64_t hash_of(const std::vector<unsigned char>& bytes) {
  sim::StateHash hash;
  hash.add_bytes(bytes.data(), bytes.size());
  return hash.value();
}

TEST(StateHash, EveryBitOfABlockCounts) {
  for (const std::size_t size : {1, 8, 63, 64, 95, 96, 200}) {
    std::vector<unsigned char> bytes(size, 0x5a);
    std::set<std::uint64_t> hashes{hash_of(bytes)};
    for (std::size_t bit = 0; bit < 8 * size; ++bit) {
      bytes[bit / 8] ^= static_cast<unsigned char>(1 << bit % 8);
      EXPECT_TRUE(hashes.insert(hash_of(bytes)).second) << "bit " << bit << " of " << size << " bytes";
      bytes[bit / 8] ^= static_cast<unsigned char>(1 << bit % 8);
    }
  }
}

TEST(StateHash, ZerosOfEveryLengthDiffer) {
  std::set<std::uint64_t> hashes;
  for (std::size_t size = 0; size < 300; ++size)
    EXPECT_TRUE(hashes.insert(hash_of(std::vector<unsigned char>(size, 0))).second) << size;
}

TEST(StateHash, TheOrderOfEqualWordsInABlockCounts) {
  std::vector<unsigned char> one(96, 0), other(96, 0);
  one[0] = other[8] = 1;  // in one chain and in the next
  EXPECT_NE(hash_of(one), hash_of(other));
  one[0] = 0;
  one[32] = 1;  // in one chain, a step later
  EXPECT_NE(hash_of(one), hash_of(other));
}

}  // namespace
