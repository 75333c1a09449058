// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/channel_access.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "tests/autonomy/second.hpp"

namespace {

using autonomy::RandomAccess;
using autonomy::Tdma;
using test::second;

constexpr std::int64_t epoch = 1'767'225'600 * second;  // a multiple of 20 s

Tdma slot(int i, int n, double slot_s = 10, double guard_s = 5) {
  Tdma::Params params;
  params.slot = i;
  params.slots = n;
  params.slot_s = slot_s;
  params.guard_s = guard_s;
  return Tdma(params);
}

TEST(Tdma, GivesEachOneTurnACycle) {
  for (const std::int64_t begin : {std::int64_t{0}, epoch, -60 * second}) {
    for (int i = 0; i < 3; ++i) {
      Tdma tdma = slot(i, 3);
      std::vector<std::int64_t> turns;
      for (std::int64_t t = 0; t < 90 * second; t += second / 2)
        if (tdma.take_turn(begin + t)) turns.push_back(t / second);
      EXPECT_EQ(turns, (std::vector<std::int64_t>{10 * i, 10 * i + 30, 10 * i + 60})) << begin;
    }
  }
}

TEST(Tdma, BeginsNothingInTheGuardTime) {
  Tdma tdma = slot(0, 2);
  EXPECT_FALSE(tdma.take_turn(5 * second));
  EXPECT_FALSE(tdma.take_turn(10 * second));  // the other's
  EXPECT_TRUE(tdma.take_turn(25 * second - 1));
  EXPECT_FALSE(tdma.take_turn(25 * second - 1));
}

TEST(Tdma, ClockThatIsSetBackGivesNoSecondTurn) {
  Tdma tdma = slot(0, 2);
  EXPECT_TRUE(tdma.take_turn(20 * second));
  EXPECT_FALSE(tdma.take_turn(3 * second));
  EXPECT_TRUE(tdma.take_turn(40 * second));
}

TEST(Tdma, ClockThatIsSetBackByAnHourSilencesItForTwoCyclesAtMost) {
  Tdma tdma = slot(0, 2);
  EXPECT_TRUE(tdma.take_turn(epoch + 3600 * second));
  std::vector<std::int64_t> turns;
  for (std::int64_t t = 3 * second; t < 100 * second; t += second)
    if (tdma.take_turn(epoch + t)) turns.push_back(t / second);
  EXPECT_EQ(turns, (std::vector<std::int64_t>{3, 20, 40, 60, 80}));
  for (const int cycles : {1, 2, 3}) {
    Tdma other = slot(0, 2);
    EXPECT_TRUE(other.take_turn(epoch + 20 * cycles * second));
    int sent = 0;
    for (std::int64_t t = 0; t <= 40 * second; t += second) sent += other.take_turn(epoch + t) ? 1 : 0;
    EXPECT_GE(sent, 1) << cycles;
  }
}

TEST(Tdma, TwoClocksThatDifferByLessThanTheGuardTimeDoNotMeet) {
  Tdma first = slot(0, 2);
  Tdma second_one = slot(1, 2);
  for (std::int64_t t = 0; t < 200 * second; t += second / 10) {
    const bool one = first.take_turn(t);
    const bool two = second_one.take_turn(t + 4 * second);  // a fast clock
    ASSERT_FALSE(one && two);
  }
}

TEST(Tdma, DefaultGuardTimeLeavesTheSlotToThePacket) {
  // A craft whose fix comes back at any time of its slot: what it sends ends within the slot, with a packet of 3.5 s
  // that the modem begins on a whole second.
  for (std::int64_t back = 0; back < 5 * second; back += second / 10) {
    Tdma tdma = slot(0, 3, 5, autonomy::default_guard_s(5));
    for (std::int64_t t = back; t < 30 * second; t += second / 10) {
      if (!tdma.take_turn(epoch + t)) continue;
      const std::int64_t into_slot = t % (15 * second);
      EXPECT_LE((into_slot + second - 1) / second * second + 3'500'000, 5 * second) << back;
    }
  }
  // Stamps once a second, of any phase, give a turn in each cycle.
  for (std::int64_t phase = 0; phase < second; phase += second / 10) {
    Tdma tdma = slot(1, 3, 5, autonomy::default_guard_s(5));
    int turns = 0;
    for (std::int64_t t = phase; t < 150 * second; t += second) turns += tdma.take_turn(t) ? 1 : 0;
    EXPECT_EQ(turns, 10) << phase;
  }
  EXPECT_EQ(autonomy::default_guard_s(1), 0.5);
}

TEST(Tdma, SlotsAreChecked) {
  EXPECT_THROW(slot(2, 2), std::invalid_argument);
  EXPECT_THROW(slot(-1, 2), std::invalid_argument);
  EXPECT_THROW(slot(0, 0), std::invalid_argument);
  EXPECT_THROW(slot(0, 1, 5, 5), std::invalid_argument);
  EXPECT_THROW(slot(0, 1, 0, 0), std::invalid_argument);
}

TEST(RandomAccess, ScattersAboutItsMean) {
  RandomAccess access(10, 0.5, 1, "auv");
  std::vector<std::int64_t> turns;
  for (std::int64_t t = 0; t < 20'000 * second; t += second / 100)
    if (access.take_turn(t)) turns.push_back(t);
  ASSERT_GT(turns.size(), 1000u);
  for (std::size_t i = 1; i < turns.size(); ++i) {
    EXPECT_GE(turns[i] - turns[i - 1], 5 * second);
    EXPECT_LE(turns[i] - turns[i - 1], 15 * second + second / 100);
  }
  // 2000 intervals with a standard deviation of 10 / sqrt(12): their mean to 0.065 s, four sigma.
  const double mean_s =
      static_cast<double>(turns.back() - turns.front()) * 1e-6 / static_cast<double>(turns.size() - 1);
  EXPECT_NEAR(mean_s, 10, 0.26);
  EXPECT_LE(turns.front(), 10 * second);
}

TEST(RandomAccess, ClockThatIsSetBackDoesNotSilenceIt) {
  RandomAccess access(10, 0.5, 1, "auv");
  for (std::int64_t t = 0; t < 100 * second; t += second / 10) access.take_turn(epoch + 3600 * second + t);
  std::vector<std::int64_t> turns;
  for (std::int64_t t = 0; t < 300 * second; t += second / 10)
    if (access.take_turn(epoch + t)) turns.push_back(t);
  ASSERT_GE(turns.size(), 19u);  // the first within 10 s, the others each 15 s at the latest
  EXPECT_LE(turns.front(), 10 * second);
  for (std::size_t i = 1; i < turns.size(); ++i) EXPECT_GE(turns[i] - turns[i - 1], 5 * second - second / 10);
}

TEST(RandomAccess, SameSeedAndNameGiveTheSameTurns) {
  const auto turns = [](std::uint64_t seed, const char* name) {
    RandomAccess access(10, 1, seed, name);
    std::vector<std::int64_t> all;
    for (std::int64_t t = 0; t < 500 * second; t += second / 10)
      if (access.take_turn(t)) all.push_back(t);
    return all;
  };
  EXPECT_EQ(turns(1, "a"), turns(1, "a"));
  EXPECT_NE(turns(1, "a"), turns(1, "b"));
  EXPECT_NE(turns(1, "a"), turns(2, "a"));
}

TEST(RandomAccess, ParametersAreChecked) {
  EXPECT_THROW(RandomAccess(0, 0.5, 1, "a"), std::invalid_argument);
  EXPECT_THROW(RandomAccess(1, 1.5, 1, "a"), std::invalid_argument);
  EXPECT_THROW(RandomAccess(1, -0.1, 1, "a"), std::invalid_argument);
}

}  // namespace
