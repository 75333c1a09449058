// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/record_input.hpp"

#include <gmock/gmock.h>

#include "motion/record/joint_commands.hpp"
#include "tests/motion/record/joint_commands_fixture.hpp"

namespace {

using namespace joint_commands_fixture;

using experiment::InputEvent;
using testing::ElementsAre;

TEST(RecordInput, TakesEventsOfAFileUpToATime) {
  motion::JointCommands held = commands();
  // Codes of the keys 1, w and 3; times far from 0, as the kernel stamps them.
  motion::EventFileInput file({{5'000'000, InputEvent::button, 2, 1},
                               {5'008'000, InputEvent::button, 17, 1},
                               {5'008'000, InputEvent::button, 4, 1},
                               {5'008'001, InputEvent::button, 2, 0},
                               {5'020'000, InputEvent::report, InputEvent::report_dropped, 0}});
  EXPECT_TRUE(file.read(0, held));
  EXPECT_THAT(held.velocities(), ElementsAre(2, 0, 0));
  EXPECT_TRUE(file.read(8000, held));
  EXPECT_THAT(held.velocities(), ElementsAre(2, -0.5, 2));
  EXPECT_TRUE(file.read(16000, held));
  EXPECT_THAT(held.velocities(), ElementsAre(0, -0.5, 2));
  // The kernel has dropped events: what is held is unknown.
  EXPECT_FALSE(file.read(24000, held));
  EXPECT_THAT(held.velocities(), ElementsAre(0, 0, 0));
}

}  // namespace
