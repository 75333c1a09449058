// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "devices/motion/joint_group.hpp"
#include "tests/devices/joint/leg_fixture.hpp"
#include "tests/devices/motion/joint_group_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace joint_group_fixture;

using testing::HasSubstr;

TEST(JointGroup, CountsSetPointsBeyondTheRangeOfAServo) {
  test::TestWorld test(test::leg_world(group));
  test.send("dog.group.cmd", frames({"knee"}, {{1.5}}));
  test.run_for(0.05);
  EXPECT_NEAR(set_point(test, "knee"), 1, 1e-12);  // high_stop
  EXPECT_GT(group_of(test).counts().clipped, 0);
}

TEST(JointGroup, SaysWhatIsWrongWithItsParameters) {
  const auto error = [](const std::string& keys) {
    return test::error_of_world(test::leg_world("        - {name: group, type: joint_group, " + keys + "}\n"));
  };
  EXPECT_THAT(error("joints: [hip, kne]"),
              HasSubstr("'joints' names 'kne', which is not a joint_servo of the vehicle"));
  EXPECT_THAT(error("joints: [knee, maker/knee]"), HasSubstr("'joints' names 'maker/knee' twice"));
  EXPECT_THAT(error("frame_s: 0"), HasSubstr("'frame_s' must be >= 0.001 and <= 1"));
  EXPECT_THAT(error("limits: [{joint: knee, by: tail, from_deg: 0}]"), HasSubstr("'limits' names 'tail'"));
  EXPECT_THAT(error("limits: [{joint: knee, by: knee, from_deg: 0}]"), HasSubstr("'by' must be another joint"));
  EXPECT_THAT(error("limits: [{joint: knee, by: hip, from_deg: 0, low_deg: 2, high_deg: 1}]"),
              HasSubstr("'high_deg' must not be below 'low_deg'"));
}

}  // namespace
