// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/check_script.hpp"

#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"

namespace {

using testing::HasSubstr;

std::string error_of(const std::string& objects, const std::string& script) {
  return test::error_of_world("shoal: 1\nphysics: {step_s: 0.01}\nobjects: [" + objects + "]\n" + script);
}

const std::string cart = "{name: cart, parts: [{shape: box, mass_kg: 1}]}";
const std::string ride = "{name: ride, object: cart, points: [[0, 0, 1], [1, 0, 1]]}";

TEST(CheckScript, AnActorMovesOneObjectOfItsOwn) {
  EXPECT_EQ(error_of(cart, "actors: [" + ride + "]\n"), "");
  EXPECT_THAT(error_of("{name: cart, count: 2, parts: [{shape: box}]}", "actors: [" + ride + "]\n"),
              HasSubstr("object"));
  EXPECT_THAT(error_of(cart, "actors: [" + ride + ", {name: other, object: cart, points: [[0, 0, 1], [1, 0, 1]]}]\n"),
              HasSubstr("actor 'other': object 'cart' is already moved by another actor"));
}

TEST(CheckScript, AnEventRepeatsNoFasterThanTheSteps) {
  EXPECT_EQ(error_of("", "events: [{name: a, every: 0.01, do: [{log: a}]}]\n"), "");
  EXPECT_THAT(error_of("", "events: [{name: a, every: 0.009, do: [{log: a}]}]\n"),
              HasSubstr("event 'a': 'every' must be at least a step of 0.01 s"));
}

TEST(CheckScript, ActionsWithinActionsAreCheckedToo) {
  EXPECT_THAT(error_of("", "events: [{name: a, at: 0, do: [{one_of: [[{log: x}], [{clear_fault: r1/gps}]]}]}]\n"),
              HasSubstr("there is no device 'r1/gps'; devices are named VEHICLE/DEVICE"));
}

// What `set` may not change while a device runs.

struct Case {
  std::string device, key, value;
};

TEST(DeviceChange, RefusesKeysThatOnlyConstructionUses) {
  const std::string wheels = ", left_joint: left, right_joint: right";
  const std::string ackermann =
      "ackermann_drive, left_steer_joint: left, right_steer_joint: right, drive_joints: [left, right]";
  const std::string skid = "skid_steer, left_joints: [left], right_joints: [right]";
  for (const Case& c : std::vector<Case>{{"joint_state", "joints", "[left]"},
                                         {"joint_state", "effort", "false"},
                                         {"joint_load, joint: left", "joint", "right"},
                                         {"wheel_encoder, joints: [left]", "joints", "[right]"},
                                         {"wheel_encoder, joints: [left]", "ticks_per_revolution", "7"},
                                         {"bumper", "parts", "[chassis/hull]"},
                                         {ackermann, "left_steer_joint", "right"},
                                         {ackermann, "right_steer_joint", "left"},
                                         {ackermann, "drive_joints", "[left]"},
                                         {skid, "left_joints", "[right]"},
                                         {skid, "right_joints", "[left]"},
                                         {"differential_drive" + wheels, "left_joint", "right"},
                                         {"differential_drive" + wheels, "right_joint", "left"},
                                         {"joint_servo, joint: left", "joint", "right"},
                                         {"joint_servo, joint: left", "axis", "1"},
                                         {"joint_servo, joint: left", "alias", "l"},
                                         {"joint_motor, joint: left", "joint", "right"},
                                         {"buoyancy_engine", "initial_m3", "1e-5"},
                                         {"moving_mass", "motion", "turn"},
                                         {"sail", "initial_deg", "40"},
                                         {"battery", "initial_charge", "0.5"}}) {
    test::TestWorld test(test::rover_world("        - {name: d, type: " + c.device + "}\n"));
    EXPECT_THAT(test.change("r1/d", "{" + c.key + ": " + c.value + "}"),
                testing::HasSubstr("'" + c.key + "' cannot change while the device runs"))
        << c.device;
  }
}

TEST(DeviceChange, OtherKeysOfTheSameDevicesChange) {
  test::TestWorld test(test::rover_world("        - {name: d, type: joint_load, joint: left}\n"));
  EXPECT_EQ(test.change("r1/d", "{frame: world}"), "");
  EXPECT_EQ(test.change("r1/d", "{force_noise: {gaussian_std: 1}}"), "");
}

}  // namespace
