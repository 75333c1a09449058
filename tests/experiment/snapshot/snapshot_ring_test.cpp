// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/snapshot_ring.hpp"

#include <gtest/gtest.h>

#include <random>

#include "sim/state/state_archive.hpp"

namespace {

using experiment::SnapshotRing;

/// A state of three parts: one that moves, one that stays, one whose length changes.
sim::Bytes state_at(std::int64_t step) {
  auto archive = sim::StateArchive::saver();
  std::mt19937_64 draw(static_cast<std::uint64_t>(step));
  std::vector<double> moving(200), standing(2000, 1.25);
  for (double& value : moving) value = static_cast<double>(draw() >> 12);
  std::vector<std::int64_t> queue(static_cast<std::size_t>(step % 7), step);
  archive.section("moving");
  archive(moving);
  archive.section("standing");
  archive(standing);
  archive.section("queue");
  archive(queue);
  archive.end();
  return archive.take_bytes();
}

TEST(SnapshotRing, GivesBackWhatWasAddedBitForBit) {
  SnapshotRing ring(10'000, 1 << 24);
  for (std::int64_t step = 0; step <= 10'000; step += 100) ring.add(step, state_at(step));
  EXPECT_EQ(ring.size(), 101u);
  for (std::int64_t step = 0; step <= 10'000; step += 100) EXPECT_EQ(ring.get(step), state_at(step)) << step;
  EXPECT_EQ(ring.newest_until(4'399), 4'300);
  EXPECT_EQ(ring.newest_until(4'400), 4'400);
  EXPECT_EQ(ring.newest_until(-1), std::nullopt);
}

TEST(SnapshotRing, KeepsNoMoreStepsThanAskedForButAFamily) {
  SnapshotRing ring(2'000, 1 << 24);
  for (std::int64_t step = 0; step <= 100'000; step += 100) ring.add(step, state_at(step));
  // 2000 steps, and at most 30 snapshots that tilt on the same whole one.
  EXPECT_LE(*ring.oldest(), 98'000);
  EXPECT_GT(*ring.oldest(), 98'000 - 3'000);
  EXPECT_EQ(ring.get(*ring.oldest()), state_at(*ring.oldest()));
}

TEST(SnapshotRing, KeepsNoMoreBytesThanAskedFor) {
  constexpr std::size_t max = 200'000;
  SnapshotRing ring(1'000'000, max);
  for (std::int64_t step = 0; step <= 100'000; step += 100) {
    ring.add(step, state_at(step));
    EXPECT_LE(ring.bytes(), max);
  }
  EXPECT_GT(*ring.oldest(), 0);
}

TEST(SnapshotRing, KeepsNoMoreBytesThanAskedForThoughNothingCanBeCompressed) {
  // A tenth of the room for each: with one whole and its differences only, 30 of them would stay.
  constexpr std::size_t max = 1'000'000;
  SnapshotRing ring(1'000'000, max);
  for (std::int64_t step = 0; step < 60; ++step) {
    std::mt19937_64 draw(static_cast<std::uint64_t>(step));
    sim::Bytes noise(100'000);
    for (std::byte& byte : noise) byte = static_cast<std::byte>(draw());
    ring.add(step, noise);
    EXPECT_LE(ring.bytes(), max);
    EXPECT_EQ(ring.get(step), noise);
  }
  EXPECT_GE(ring.size(), 3u);
}

TEST(SnapshotRing, WhatStandsStillCostsNextToNothing) {
  SnapshotRing ring(1'000'000, 1 << 24);
  const sim::Bytes state = state_at(3);
  for (std::int64_t step = 0; step < 30; ++step) ring.add(step, state);
  // One whole one as it is, once more of at most its size, memory for a difference, and 29 of zeros with the names of
  // three parts.
  EXPECT_LT(ring.bytes(), 3 * state.size() + 29 * 300);
}

TEST(SnapshotRing, ForgetsTheFutureAndContinuesFromThere) {
  SnapshotRing ring(10'000, 1 << 24);
  for (std::int64_t step = 0; step <= 10'000; step += 100) ring.add(step, state_at(step));
  const std::size_t all = ring.bytes();
  ring.discard_after(4'250);
  EXPECT_LT(ring.bytes(), all);
  EXPECT_EQ(ring.size(), 43u);
  EXPECT_EQ(ring.newest_until(9'999), 4'200);
  for (std::int64_t step = 4'300; step <= 10'000; step += 100) ring.add(step, state_at(step + 1));
  EXPECT_EQ(ring.get(4'200), state_at(4'200));
  EXPECT_EQ(ring.get(9'000), state_at(9'001));
  ring.discard_after(-1);
  EXPECT_EQ(ring.size(), 0u);
  EXPECT_EQ(ring.bytes(), 0u);
  ring.add(5, state_at(5));
  EXPECT_EQ(ring.get(5), state_at(5));
}

/// Zeros alone, among others, in pairs, at the start and at the end, and lengths that are not multiple of a word.
TEST(SnapshotRing, GivesBackZerosWhereverTheyAre) {
  for (const std::size_t max : {std::size_t{1} << 24, std::size_t{100}}) {  // as they are, and deflated
    std::mt19937_64 draw(7);
    for (int round = 0; round < 300; ++round) {
      SnapshotRing ring(1'000, max);
      sim::Bytes bytes(draw() % 200);
      for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = draw() % 3 == 0 || i / 8 % (2 + round % 5) == 0 ? std::byte{0} : static_cast<std::byte>(draw());
      ring.add(1, bytes);
      EXPECT_EQ(ring.get(1), bytes);
    }
  }
}

TEST(SnapshotRing, TakesBytesThatHaveNoParts) {
  SnapshotRing ring(100, 1 << 20);
  const sim::Bytes odd(37, std::byte{0xff});
  ring.add(1, odd);
  ring.add(2, {});
  ring.add(3, odd);
  EXPECT_EQ(ring.get(1), odd);
  EXPECT_EQ(ring.get(2), sim::Bytes{});
  EXPECT_EQ(ring.get(3), odd);
}

}  // namespace
