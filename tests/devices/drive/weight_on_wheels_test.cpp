// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/weight_on_wheels.hpp"

#include <gmock/gmock.h>

#include "shoal/twist_command_t.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/drive/drive_support.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using testing::HasSubstr;

/// A rover whose two wheels are in the middle, with one caster before and one behind the axle, so far above the ground.
/// `more`: contacts.
std::string rover(double front_m, double rear_m, const std::string& contacts = "") {
  const auto caster = [](const std::string& name, const std::string& x, double up_m) {
    return "            - {name: " + name + ", shape: sphere, radius_m: 0.05, position_m: [" + x + ", 0, " +
           std::to_string(-0.05 + up_m) + "], mass_kg: 0.1, material: slick}\n";
  };
  return R"(
shoal: 1
physics: {step_s: 0.01}
materials: [{name: slick}]
contacts: [{between: [slick, any], friction: 0})" +
         contacts + R"(]
objects: [{name: ground, fixed: true, parts: [{shape: plane}]}]
vehicles:
  - name: r1
    model:
      shoal: 1
      vehicle: test_rover
      bodies:
        - name: chassis
          position_m: [0, 0, 0.1]
          parts:
            - {name: hull, shape: box, size_m: [0.4, 0.3, 0.1], position_m: [-0.01, 0, 0.03], mass_kg: 17}
)" + caster("front", "0.2", front_m) +
         caster("rear", "-0.2", rear_m) + R"(
        - {name: left_wheel, position_m: [0, 0.2, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1.5}]}
        - {name: right_wheel, position_m: [0, -0.2, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1.5}]}
      joints:
        - {name: left, type: hinge, bodies: [chassis, left_wheel], anchor_m: [0, 0.2, 0.1], axis: [0, 1, 0]}
        - {name: right, type: hinge, bodies: [chassis, right_wheel], anchor_m: [0, -0.2, 0.1], axis: [0, 1, 0]}
      devices:
        - {name: drive, type: differential_drive, left_joint: left, right_joint: right}
)";
}

using test::warnings_of;

/// Of the turn rate that was asked for, on the spot.
double share_of_turn(const std::string& yaml) {
  const test_support::LogCapture log;
  test::TestWorld test(yaml);
  shoal::twist_command_t command{};
  command.turn_radps = 1;
  test.send("r1.drive.cmd", command);
  test.run_for(1);
  double turned_rad = 0;
  sim::Pose before = test.world.find_vehicle("r1")->X_WV();
  for (int i = 0; i < 40; ++i) {
    test.run_for(0.1);
    const sim::Pose now = test.world.find_vehicle("r1")->X_WV();
    turned_rad += sim::yaw_of((before.inverse() * now).linear());
    before = now;
  }
  return turned_rad / 4;
}

TEST(WeightOnWheels, IsUndeterminedWithCastersBeforeAndBehind) {
  EXPECT_THAT(warnings_of(rover(0, 0)),
              HasSubstr("vehicle 'r1': device 'drive': how much weight its driven wheels carry is undetermined: "
                        "'chassis/front', 'chassis/rear' stand as low as they (4 points of one rigid vehicle)"));
}

TEST(WeightOnWheels, IsDeterminedWithOneCasterRaised) {
  EXPECT_EQ(warnings_of(rover(0.001, 0)), "");
  EXPECT_EQ(warnings_of(rover(0.0005, 0.0005)), "");
}

/// A caster that is lower tips the rover on to it and one wheel, or on to both and no wheel.
TEST(WeightOnWheels, IsUndeterminedWithCastersBelowTheWheels) {
  EXPECT_THAT(warnings_of(rover(-0.001, -0.001)), HasSubstr("is undetermined"));
}

/// Casters with friction carry what they like, and hold the rover back; raised by 0.1 mm they do not touch.
TEST(WeightOnWheels, DecidesHowFastItTurns) {
  const std::string friction = ", {between: [slick, any], friction: 0.8}";
  EXPECT_LT(share_of_turn(rover(0, 0, friction)), 0.5);
  EXPECT_NEAR(share_of_turn(rover(0.0001, 0.0001, friction)), 1, 0.01);
  EXPECT_NEAR(share_of_turn(rover(0.001, 0, friction)), 1, 0.01);
}

TEST(WeightOnWheels, IsNotLookedAtWithASuspensionOrSoftContacts) {
  EXPECT_EQ(warnings_of(rover(0, 0, ", {between: [any, any], soft_cfm: 0.001}")), "");
  std::string yaml = rover(0, 0);
  const std::string hinge = "type: hinge, bodies: [chassis, left_wheel], anchor_m: [0, 0.2, 0.1], axis: [0, 1, 0]";
  yaml.replace(yaml.find(hinge), hinge.size(),
               "type: hinge2, bodies: [chassis, left_wheel], anchor_m: [0, 0.2, 0.1], axis: [0, 0, 1], low_stop: 0, "
               "high_stop: 0, suspension_erp: 0.4, suspension_cfm: 0.001, axis2: {axis: [0, 1, 0]}");
  EXPECT_EQ(warnings_of(yaml), "");
}

/// The weight on the driven rear axle follows from the middle of mass, and so it does with casters on one side of it.
TEST(WeightOnWheels, IsDeterminedWithTheOthersOnOneLineBesideTheAxle) {
  std::string yaml = rover(0.01, 0.01);
  const std::size_t wheel = yaml.find("        - {name: left_wheel");
  yaml.insert(wheel,
              "            - {name: left_foot, shape: sphere, radius_m: 0.05, position_m: [0.2, 0.1, -0.05]}\n"
              "            - {name: right_foot, shape: sphere, radius_m: 0.05, position_m: [0.2, -0.1, -0.05]}\n");
  EXPECT_EQ(warnings_of(yaml), "");
}

}  // namespace
