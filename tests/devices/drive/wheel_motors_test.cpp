// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "devices/drive/skid_steer.hpp"
#include "shoal/wheel_speeds_command_t.hpp"
#include "tests/devices/drive/skid_steer_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace skid_steer_fixture;

TEST(SkidSteer, AllWheelsOfASideTurnAlike) {
  test::TestWorld test(skid_world(track));
  shoal::wheel_speeds_command_t command{};
  command.left_radps = 3;
  command.right_radps = 5;
  test.send("r1.drive.cmd", command);
  test.run_for(1);
  for (const char* name : {"fl", "rl"}) EXPECT_NEAR(rover(test).joint(name).velocity(), 3, 0.02) << name;
  for (const char* name : {"fr", "rr"}) EXPECT_NEAR(rover(test).joint(name).velocity(), 5, 0.02) << name;
}

}  // namespace
