// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/joint_commands.hpp"

#include <gmock/gmock.h>

#include "motion/record/record_input.hpp"
#include "tests/motion/record/joint_commands_fixture.hpp"

namespace {

using namespace joint_commands_fixture;

using testing::ElementsAre;

TEST(JointCommands, AllKeysOfAFrameMoveTheirJointsInThisFrame) {
  motion::JointCommands held = commands();
  held.key("1", true);
  held.key("w", true);
  held.key("3", true);
  EXPECT_THAT(held.velocities(), ElementsAre(2, -0.5, 2));
  held.key("w", false);
  EXPECT_THAT(held.velocities(), ElementsAre(2, 0, 2));
  // Both keys of a joint hold it.
  held.key("q", true);
  EXPECT_THAT(held.velocities(), ElementsAre(0, 0, 2));
}

TEST(JointCommands, AKeyThatGoesDownAndUpWithinAFrameMovesItsJointForOneFrame) {
  motion::JointCommands held = commands();
  held.key("1", true);
  held.key("1", false);
  EXPECT_THAT(held.velocities(), ElementsAre(2, 0, 0));
  EXPECT_THAT(held.velocities(), ElementsAre(0, 0, 0));
}

TEST(JointCommands, ATapStartsAndStopsAJointOrTurnsItRound) {
  motion::JointCommands held = commands();
  held.tap("2");
  EXPECT_THAT(held.velocities(), ElementsAre(0, 0.5, 0));
  held.tap("w");
  EXPECT_THAT(held.velocities(), ElementsAre(0, -0.5, 0));
  held.tap("w");
  EXPECT_THAT(held.velocities(), ElementsAre(0, 0, 0));
  held.tap("1");
  held.tap("3");
  held.tap("tab");
  EXPECT_THAT(held.velocities(), ElementsAre(0, 0, 0));
}

TEST(JointCommands, SticksMoveTheJointsOfTheSelectedSet) {
  motion::JointCommands held = commands();
  EXPECT_EQ(held.set(), "leg");
  held.axis(0, 32767);
  held.axis(1, -32768);
  EXPECT_THAT(held.velocities(), ElementsAre(1, 1, 0));
  // Half of the way beyond the dead band of 0.1, here from 0 to 100.
  held.set_range(0, 0, 100);
  held.axis(0, 50 + 50 * 0.55);
  EXPECT_NEAR(held.velocities()[0], 0.5, 1e-12);
  held.button(311, true);
  EXPECT_EQ(held.set(), "toes");
  EXPECT_NEAR(held.velocities()[2], 2, 1e-12);
  EXPECT_EQ(held.velocities()[0], 0);
  held.button(310, true);
  EXPECT_EQ(held.set(), "leg");
  // A trigger halfway: the square root of 4.
  held.axis(5, 127.5);
  EXPECT_NEAR(held.velocities()[0], 1, 1e-12);
}

TEST(JointCommands, OtherKeysAreWishesAndActions) {
  motion::JointCommands held = commands({"[", "]"});
  held.key("space", true);
  held.key("]", true);
  held.key("'", true);
  held.key("enter", true);
  held.key("=", true);
  held.key("1", true);
  EXPECT_THAT(held.take_wishes(),
              ElementsAre(motion::RecordWish::pause, motion::RecordWish::push, motion::RecordWish::finish));
  EXPECT_TRUE(held.take_wishes().empty());
  EXPECT_THAT(held.take_actions(), ElementsAre(1));
  EXPECT_EQ(held.velocities()[0], 2 * 1.25);
  EXPECT_TRUE(held.uses("q"));
  EXPECT_TRUE(held.uses("tab"));
  EXPECT_FALSE(held.uses("["));
}

TEST(JointCommands, WithoutControlsThePairsOfTheKeyboardFollowTheServos) {
  motion::JointCommands held({}, names, number_of);
  held.key("2", true);
  held.key("e", true);
  EXPECT_THAT(held.velocities(), ElementsAre(0, 1, -1));
  EXPECT_EQ(held.set(), "1");
}

TEST(JointCommands, KeysOfActionsAreCharactersAndWords) {
  for (const char* name : {"[", "a", ",", "up", "escape", "backspace"}) EXPECT_TRUE(motion::is_key_name(name)) << name;
  for (const char* name : {"", " ", "ctrl+a", "upp", "up,", ", ", "up, down", "f1"})
    EXPECT_FALSE(motion::is_key_name(name)) << name;
}

}  // namespace
