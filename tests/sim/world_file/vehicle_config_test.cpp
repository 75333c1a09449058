// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/vehicle_config.hpp"

#include <gmock/gmock.h>

#include "tests/sim/config/read_yaml.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> errors_of(const std::string& yaml, sim::VehicleConfig& vehicle) {
  return test::errors_of_reading(yaml, [&](sim::ParamReader& in) {
    in.declare("material", "default");
    in.declare("category", "solid");
    vehicle.read(in);
  });
}

TEST(VehicleConfig, IsReadWithItsBodiesJointsAndDevices) {
  sim::VehicleConfig vehicle;
  EXPECT_THAT(errors_of("shoal: 1\nvehicle: cart\nmaterials: [{name: rubber}]\n"
                        "bodies:\n  - {name: base, parts: [{shape: box, mass_kg: 1}]}\n"
                        "  - {name: wheel, parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1, material: rubber}]}\n"
                        "joints: [{name: axle, type: hinge, bodies: [base, wheel], axis: [0, 1, 0]}]\n"
                        "devices: [{name: imu, type: imu, body: base}]\nactuator_latency_s: 0.02\n",
                        vehicle),
              IsEmpty());
  EXPECT_EQ(vehicle.vehicle, "cart");
  EXPECT_EQ(vehicle.bodies.size(), 2u);
  EXPECT_EQ(vehicle.joints.front().name, "axle");
  EXPECT_EQ(vehicle.devices.front().name, "imu");
  EXPECT_EQ(vehicle.actuator_latency_s, 0.02);
}

TEST(VehicleConfig, NeedsAVersionAndBodies) {
  sim::VehicleConfig vehicle;
  EXPECT_THAT(errors_of("vehicle: cart\n", vehicle),
              testing::IsSupersetOf({HasSubstr("'shoal'"), HasSubstr("'bodies'")}));
}

TEST(VehicleConfig, NamesOfDevicesAreUnique) {
  sim::VehicleConfig vehicle;
  EXPECT_THAT(errors_of("{shoal: 1, bodies: [{name: b, parts: [{shape: box, mass_kg: 1}]}], devices: [{name: a, type: "
                        "imu}, {name: a, type: gps}]}",
                        vehicle),
              ElementsAre(HasSubstr("'a'")));
}

TEST(VehicleConfig, ACopyIsIndependent) {
  sim::VehicleConfig one;
  one.vehicle = "one";
  sim::VehicleConfig other = one;
  other.vehicle = "other";
  EXPECT_EQ(one.vehicle, "one");
}

}  // namespace
