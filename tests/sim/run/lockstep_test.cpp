#include "sim/run/lockstep.hpp"

#include <gtest/gtest.h>

namespace {

using Names = std::vector<std::string>;

TEST(Lockstep, TicksEachClientInItsOwnPeriod) {
  sim::Lockstep lockstep;
  lockstep.join("slow", 10, 0);
  lockstep.join("fast", 5, 0);
  EXPECT_EQ(lockstep.due(0), (Names{"fast", "slow"}));
  EXPECT_EQ(lockstep.due(5), (Names{"fast"}));
  EXPECT_EQ(lockstep.due(7), (Names{}));
  EXPECT_EQ(lockstep.due(10), (Names{"fast", "slow"}));
}

TEST(Lockstep, MissesOnlyThoseWhoHaveNotAcknowledged) {
  sim::Lockstep lockstep;
  lockstep.join("a", 1, 0);
  lockstep.join("b", 1, 0);
  EXPECT_TRUE(lockstep.acknowledge("a", 3));
  EXPECT_EQ(lockstep.missing(3), (Names{"b"}));
  EXPECT_EQ(lockstep.missing(4), (Names{"a", "b"}));
  EXPECT_FALSE(lockstep.acknowledge("nobody", 3));
}

TEST(Lockstep, AnAcknowledgementOfAnotherStepDoesNotCount) {
  sim::Lockstep lockstep;
  lockstep.join("a", 5, 0);
  EXPECT_FALSE(lockstep.acknowledge("a", 7));  // was not asked at 7
  lockstep.acknowledge("a", 5);
  EXPECT_TRUE(lockstep.missing(5).empty());
  lockstep.acknowledge("a", 0);  // late and twice
  EXPECT_TRUE(lockstep.missing(5).empty());
  EXPECT_EQ(lockstep.missing(10), (Names{"a"}));
}

TEST(Lockstep, JoiningTwiceMovesNoTick) {
  sim::Lockstep lockstep;
  lockstep.join("a", 10, 0);
  lockstep.join("a", 10, 3);
  EXPECT_EQ(lockstep.due(10), (Names{"a"}));
  EXPECT_TRUE(lockstep.due(13).empty());
  lockstep.join("a", 4, 20);
  EXPECT_EQ(lockstep.due(24), (Names{"a"}));
}

TEST(Lockstep, AClientThatLeftIsNotAwaited) {
  sim::Lockstep lockstep;
  lockstep.join("a", 1, 0);
  EXPECT_TRUE(lockstep.leave("a"));
  EXPECT_FALSE(lockstep.leave("a"));
  EXPECT_TRUE(lockstep.missing(1).empty());
}

}  // namespace
