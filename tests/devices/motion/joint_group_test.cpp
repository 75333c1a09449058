// SPDX-License-Identifier: BSD-3-Clause
#include "devices/motion/joint_group.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "shoal/estop_t.hpp"
#include "shoal/joint_group_state_t.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "tests/devices/joint/leg_fixture.hpp"
#include "tests/devices/motion/joint_group_fixture.hpp"
#include "tests/devices/state_fixture.hpp"

namespace {

using namespace joint_group_fixture;

using testing::ElementsAre;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(JointGroup, PlaysFramesOf8MsLinearlyBetweenTheirValues) {
  test::TestWorld test(test::leg_world(group));
  test.send("dog.group.cmd", frames({"hip", "maker/knee"}, {{0.04, 0}, {0.08, 0.1}}));
  std::vector<double> hip, knee;
  for (int step = 0; step < 10; ++step) {
    test.world.step();
    hip.push_back(set_point(test, "hip"));
    knee.push_back(set_point(test, "knee"));
  }
  // The servos take a set point one step after the group, which is listed behind them: the first step is at rest.
  const double expected_hip[] = {0, .01, .02, .03, .04, .05, .06, .07, .08, .08};
  const double expected_knee[] = {0, 0, 0, 0, 0, .025, .05, .075, .1, .1};
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_NEAR(hip[i], expected_hip[i], 1e-15) << i;
    EXPECT_NEAR(knee[i], expected_knee[i], 1e-15) << i;
  }
}

TEST(JointGroup, AllJointsOfAFrameStartInTheSameStep) {
  test::TestWorld test(test::leg_world(group));
  test.run_for(0.1);
  test.send("dog.group.cmd", frames({"knee", "hip"}, {{0.1, -0.1}}));
  while (set_point(test, "hip") == 0 && test.world.now() < sim::from_seconds(0.2)) {
    EXPECT_EQ(set_point(test, "knee"), 0);
    test.world.step();
  }
  EXPECT_NEAR(set_point(test, "knee"), -set_point(test, "hip"), 1e-15);
  EXPECT_NE(set_point(test, "hip"), 0);
  EXPECT_LE(sim::to_seconds(test.world.now()) - 0.1, 0.008);  // within one frame
}

TEST(JointGroup, WithoutTheNextPacketItHoldsTheLastFrameAndCountsIt) {
  test::TestWorld test(test::leg_world(group));
  test.send("dog.group.cmd", frames({"hip"}, {{0.1}, {0.2}}));
  test.run_for(0.040);  // two frames, then three that are held
  EXPECT_EQ(group_of(test).counts().played, 2);
  EXPECT_EQ(group_of(test).counts().held, 3);
  EXPECT_NEAR(set_point(test, "hip"), 0.2, 1e-15);
  test.send("dog.group.cmd", frames({"hip"}, {{0.3}}));
  test.run_for(0.010);
  EXPECT_EQ(group_of(test).counts().late_packets, 1);
  EXPECT_EQ(group_of(test).counts().played, 3);
  EXPECT_NEAR(set_point(test, "hip"), 0.3, 1e-15);
  // The stream ends 0.1 s after its last frame; the next one is not late.
  test.run_for(1);
  const auto held = group_of(test).counts().held;
  test.run_for(1);
  EXPECT_EQ(group_of(test).counts().held, held);
  test.send("dog.group.cmd", frames({"hip"}, {{0}}));
  test.run_for(0.1);
  EXPECT_EQ(group_of(test).counts().late_packets, 1);
}

TEST(JointGroup, AStreamOfFourFramesAPacketIsNeverLate) {
  test::TestWorld test(test::leg_world(group));
  for (int packet = 0; packet < 30; ++packet) {
    const double at = 0.01 * packet;
    test.send("dog.group.cmd", frames({"hip"}, {{at}, {at}, {at}, {at}}));
    test.run_for(0.032);
  }
  EXPECT_EQ(group_of(test).counts().late_packets, 0);
  EXPECT_EQ(group_of(test).counts().refused_packets, 0);
  EXPECT_EQ(group_of(test).counts().held, 0);
}

TEST(JointGroup, RefusesPacketsThatItCannotBuffer) {
  test::TestWorld test(test::leg_world(group));
  for (int packet = 0; packet < 4; ++packet) test.send("dog.group.cmd", frames({"hip"}, {{1}, {1}, {1}, {1}}));
  test.world.step();
  EXPECT_EQ(group_of(test).counts().refused_packets, 2);  // of four packets two fit
}

TEST(JointGroup, NaNLeavesAJointAsItWas) {
  test::TestWorld test(test::leg_world(group));
  test.send("dog.group.cmd", frames({"hip", "knee"}, {{0.1, 0.2}, {nan, 0.3}}));
  test.run_for(0.1);
  EXPECT_NEAR(set_point(test, "hip"), 0.1, 1e-15);
  EXPECT_NEAR(set_point(test, "knee"), 0.3, 1e-15);
}

TEST(JointGroup, AtAnEmergencyStopItDropsItsFrames) {
  test::TestWorld test(test::leg_world("        - {name: estop, type: estop}\n" + group));
  test.send("dog.group.cmd", frames({"hip"}, {{0.01}, {0.5}}));
  test.run_for(0.006);
  shoal::estop_t stop{};
  stop.engaged = 1;
  test.send("dog.estop.cmd", stop);
  test.run_for(0.5);
  EXPECT_LT(set_point(test, "hip"), 0.02);
  EXPECT_EQ(group_of(test).waiting(), 0);
}

TEST(JointGroup, ReportsItsSetPointsAndCounts) {
  test::TestWorld test(test::leg_world(group));
  test::Listener<shoal::joint_group_state_t> reports(test, "dog.group");
  test.send("dog.group.cmd", frames({"hip"}, {{0.2}}));
  test.run_for(0.5);
  const shoal::joint_group_state_t last = reports.last();
  EXPECT_THAT(last.joint_name, ElementsAre("hip", "knee"));
  EXPECT_NEAR(last.set_point[0], 0.2, 1e-12);
  EXPECT_NEAR(last.position[0], 0.2, 1e-6);  // without gravity, after 0.5 s
  EXPECT_EQ(last.played, 1);
}

TEST(JointGroup, IgnoresBadPacketsAndContinues) {
  test::TestWorld test(test::leg_world(group));
  const double infinity = std::numeric_limits<double>::infinity();
  test.send("dog.group.cmd", frames({"hip"}, {}));
  test.send("dog.group.cmd", frames({"tail"}, {{1}}));
  test.send("dog.group.cmd", frames({"knee", "maker/knee"}, {{1, 1}}));
  test.send("dog.group.cmd", frames({"hip"}, {{infinity}}));
  test.send("dog.group.cmd", frames({"hip"}, {{1}, {1}, {1}, {1}, {1}}));
  test.run_for(0.1);
  EXPECT_EQ(set_point(test, "hip"), 0);
  EXPECT_EQ(group_of(test).counts().played, 0);
}

TEST(JointGroup, ContinuesWithItsFramesFromASnapshot) {
  test::SavedRun run(test::leg_world(group), [](test::TappedWorld& world, int step) {
    if (step % 20 == 0)
      world.send("dog.group.cmd", frames({"hip", "knee"}, {{0.1, 0.2}, {0.2, nan}, {0.1 * (step % 3), 0}}));
  });
  run.expect_restored_worlds_go_on_alike({2, 3, 21, 35, 60}, 100);
}

}  // namespace
