// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"

namespace {

std::string world_of(const std::string& action) {
  return test::box_world("        - {name: imu, type: imu, rate_hz: 10}\n", "{step_s: 0.01}",
                         "events:\n  - {name: a, at: 0, do: [" + action + "]}\n");
}

TEST(ClearFault, NamesTheDeviceAlone) {
  EXPECT_EQ(test::error_of_world(world_of("{clear_fault: r1/imu}")), "");
  EXPECT_EQ(test::error_of_world(world_of("{clear_fault: {device: r1/imu}}")), "");
}

TEST(ClearFault, SaysWhichDevicesThereAre) {
  EXPECT_THAT(
      test::error_of_world(world_of("{clear_fault: r1/gps}")),
      testing::HasSubstr("there is no device 'r1/gps'; devices are named VEHICLE/DEVICE; vehicle 'r1' has: imu"));
  EXPECT_THAT(test::error_of_world(world_of("{clear_fault: {}}")), testing::HasSubstr("'device'"));
}

TEST(ClearFault, EndsAllFaultsOfTheDevice) {
  test::TestWorld test(world_of("{clear_fault: r1/imu}"));
  for (const sim::FaultKind kind : {sim::FaultKind::silent, sim::FaultKind::stuck}) {
    sim::FaultConfig fault;
    fault.kind = kind;
    test.world.editor().set_fault("r1/imu", fault);
  }
  const auto reports = test.bus.open_mailbox("r1.imu", 100);
  test.run_for(1);
  EXPECT_TRUE(reports->take());
}

}  // namespace
