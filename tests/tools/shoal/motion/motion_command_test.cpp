// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/tools/shoal/motion/leg_files.hpp"
#include "tools/shoal/motion/motion_commands.hpp"

namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(MotionCommand, SaysWhatAFileIsThatIsNoMotion) {
  const test::LegFiles files;
  EXPECT_THAT([&] { tools::motion_of(files.path("leg.yaml")); },
              ThrowsMessage<sim::ConfigError>(HasSubstr("this is a vehicle, not a motion")));
  const std::string walk = files.write("walk.motion", "#WEBOTS_MOTION,V1.0,knee\n00:00:000,Pose1,0\n");
  EXPECT_THAT(
      [&] { tools::motion_of(walk); },
      ThrowsMessage<sim::ConfigError>(HasSubstr("looks like the format 'webots'; `shoal motion import` reads it")));
}

TEST(MotionCommand, AVehicleIsThatOfTheArgumentElseThatOfTheMotion) {
  const test::LegFiles files;
  sim::JointMotion motion;
  EXPECT_THAT([&] { tools::vehicle_of("", motion); },
              ThrowsMessage<command_line::UsageError>(HasSubstr("the motion names no vehicle")));
  EXPECT_EQ(tools::vehicle_of(files.path("leg.yaml"), motion).vehicle, "leg");
  motion.vehicle = "ers7";
  EXPECT_EQ(tools::vehicle_of("", motion).vehicle, "ers7") << "a shipped one";
  EXPECT_EQ(tools::vehicle_of(files.path("leg.yaml"), motion).vehicle, "leg");
}

}  // namespace
