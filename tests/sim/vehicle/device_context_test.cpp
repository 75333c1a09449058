// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/device_context.hpp"

#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"

namespace {

TEST(DeviceContext, ADeviceThatNeedsSoundNeedsWater) {
  EXPECT_THAT(test::error_of_world(test::box_world("        - {name: modem, type: acoustic_modem}\n")),
              testing::HasSubstr("vehicle 'r1': device 'modem': a device of type 'acoustic_modem' needs water to carry "
                                 "its sound: the world has no 'medium: {water: ...}'"));
}

/// The first acceleration of an IMU with noise.
std::string first_report(const std::string& name, const std::string& seed) {
  test::TestWorld test(test::box_world(
      "        - {name: " + name + ", type: imu, channel: report, phase_s: 0, accel_noise: {gaussian_std: 1}}\n",
      "{step_s: 0.01}", "run: {seed: " + seed + "}\n"));
  const auto reports = test.bus.open_mailbox("report", 10);
  test.run_for(0.1);
  const auto message = reports->take();
  return message ? std::string(reinterpret_cast<const char*>(message->payload.data()), message->payload.size()) : "";
}

TEST(DeviceContext, RandomErrorsAreThoseOfTheSeedAndOfTheNameOfTheDevice) {
  const std::string first = first_report("imu", "1");
  EXPECT_NE(first, "");
  EXPECT_EQ(first, first_report("imu", "1"));
  EXPECT_NE(first, first_report("imu", "2"));
  EXPECT_NE(first, first_report("imu2", "1"));
}

}  // namespace
