// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/device_config.hpp"

#include <gmock/gmock.h>

#include "sim/device/device_registry.hpp"
#include "tests/sim/config/read_yaml.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> errors_of(const std::string& yaml, sim::DeviceConfig& device) {
  return test::errors_of_reading(yaml, [&](sim::ParamReader& in) {
    for (const char* body : {"hull", "world"}) in.declare("body", body);
    device.read(in);
  });
}

TEST(DeviceConfig, HasTheRateOfItsTypeUnlessItIsGiven) {
  sim::DeviceConfig imu;
  EXPECT_THAT(errors_of("{name: imu, type: imu}", imu), IsEmpty());
  ASSERT_NE(imu.device_type, nullptr);
  EXPECT_EQ(imu.rate_hz, imu.device_type->default_rate_hz);
  EXPECT_THAT(errors_of("{name: imu, type: imu, rate_hz: 7}", imu), IsEmpty());
  EXPECT_EQ(imu.rate_hz, 7);
  EXPECT_THAT(errors_of("{name: imu, type: imu, rate_hz: every_step}", imu), IsEmpty());
  EXPECT_EQ(imu.rate_hz, 0);
}

TEST(DeviceConfig, AnUnknownTypeIsTheOnlyError) {
  sim::DeviceConfig device;
  const auto errors = errors_of("{name: l, type: lidr, beams: 3, whatever: [1, 2]}", device);
  EXPECT_THAT(errors, ElementsAre(testing::AllOf(HasSubstr("unknown device type 'lidr'; known types: "),
                                                 HasSubstr("did you mean 'lidar'?"))));
  EXPECT_EQ(device.name, "l");
  EXPECT_EQ(device.device_type, nullptr);
}

TEST(DeviceConfig, IsMountedOnABodyOfItsVehicle) {
  sim::DeviceConfig device;
  EXPECT_THAT(errors_of("{name: imu, type: imu, body: hull, position_m: [1, 2, 3], rpy_deg: [0, 0, 90]}", device),
              IsEmpty());
  EXPECT_TRUE((device.X_BS() * sim::Vector3d(1, 0, 0)).isApprox(sim::Vector3d(1, 3, 3)));
  EXPECT_THAT(errors_of("{name: imu, type: imu, body: world}", device),
              ElementsAre(HasSubstr("'body' must be a body of the vehicle, got 'world'")));
}

TEST(DeviceConfig, OnlyActuatorsHaveAWatchdog) {
  sim::DeviceConfig motor;
  EXPECT_THAT(errors_of("{name: imu, type: imu, watchdog_s: 1}", motor), ElementsAre(HasSubstr("watchdog_s")));
  const auto errors = errors_of("{name: t, type: thruster, watchdog_s: 0.5, safe: park}", motor);
  EXPECT_EQ(motor.watchdog_s, 0.5);
  EXPECT_THAT(errors, testing::Contains(HasSubstr("'safe'")));  // a propeller has no parking position
}

TEST(DeviceConfig, KeepsItsPlaceAndSourceForLaterErrors) {
  sim::DeviceConfig device;
  EXPECT_THAT(errors_of("\n\nname: imu\ntype: imu\n", device), IsEmpty());
  EXPECT_EQ(device.place.line, 3);
  ASSERT_NE(device.source, nullptr);
  EXPECT_EQ(device.source->find("type")->scalar, "imu");
}

}  // namespace
