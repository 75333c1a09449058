// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/imported_vehicle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/shoal/urdf/urdf_texts.hpp"

namespace {

using sim::Vector3d;
using test::imported;
using test::link_text;
using test::notes_of;
using test::robot_text;
using testing::HasSubstr;

TEST(ImportedVehicle, ListsWhatItLeavesOut) {
  const tools::ImportedVehicle vehicle =
      imported(robot_text(link_text("a") + link_text("b") +
                          test::joint_text("continuous",
                                           "<limit effort=\"1\" velocity=\"1\"/><mimic joint=\"k\"/>"
                                           "<dynamics damping=\"0.5\" friction=\"2\"/><calibration rising=\"0\"/>") +
                          "<gazebo/>\n<transmission name=\"t\"/>\n"));
  EXPECT_EQ(
      notes_of(vehicle),
      "r.urdf:5: <gazebo> is not imported\n"
      "r.urdf:6: <transmission> is not imported\n"
      "r.urdf:4: joint 'j': <calibration> is not imported\n"
      "r.urdf:4: joint 'j': its friction, 2, is not imported: it is not below its effort, 1\n"
      "r.urdf:4: joint 'j' moves on its own: its <mimic> names 'k', and no other joint that moves has this name\n");
}

TEST(ImportedVehicle, FixesABaseToTheWorld) {
  const std::string massless = "<link name=\"a\"/>\n" + link_text("b");
  const std::string urdf = robot_text(massless + test::joint_text("continuous", "<axis xyz=\"0 0 1\"/>"));
  EXPECT_THAT(test::import_error(urdf), HasSubstr("body 'a': must have a mass"));
  const tools::ImportedVehicle vehicle = imported(urdf, tools::Base::fixed);
  ASSERT_EQ(vehicle.joints.size(), 2u);
  EXPECT_EQ(vehicle.joints[1].type, sim::JointType::fixed);
  EXPECT_EQ(vehicle.joints[1].first + " " + vehicle.joints[1].second, "a world");
  EXPECT_EQ(vehicle.bodies[0].mass_kg, 1);
}

TEST(ImportedVehicle, TakesARootLinkNamedWorldForTheWorld) {
  // Shoal counts how the second body, the world, moves on the first: its axis is the opposite one.
  const tools::ImportedVehicle vehicle = imported(robot_text(
      "<link name=\"world\"/>\n" + link_text("b") +
      "<joint name=\"j\" type=\"prismatic\"><parent link=\"world\"/><child link=\"b\"/><origin xyz=\"0 0 2\"/>"
      "<limit lower=\"0\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint>"));
  ASSERT_EQ(vehicle.bodies.size(), 1u);
  EXPECT_EQ(vehicle.bodies[0].X_VB.translation(), Vector3d(0, 0, 2));
  EXPECT_EQ(vehicle.joints.at(0).first + " " + vehicle.joints[0].second, "b world");
  EXPECT_EQ(vehicle.joints[0].axis_V, -Vector3d::UnitX());
  EXPECT_EQ(vehicle.joints[0].high_stop, 1);
}

using sim::Vector3d;
using test::imported;
using test::notes_of;
using test::pair_text;
using testing::HasSubstr;

const std::string right_angle = "1.5707963267948966";  // pi / 2

TEST(ImportedVehicle, MakesAHingeOfARevoluteJoint) {
  const tools::ImportedVehicle vehicle = imported(pair_text(
      "revolute", "<origin xyz=\"1 2 3\" rpy=\"0 0 " + right_angle +
                      "\"/><axis xyz=\"0 2 0\"/><limit lower=\"-1\" upper=\"0.5\" effort=\"3\" velocity=\"4\"/>"));
  ASSERT_EQ(vehicle.bodies.size(), 2u);
  EXPECT_EQ(vehicle.bodies[1].X_VB.translation(), Vector3d(1, 2, 3));
  const tools::ImportedJoint& joint = vehicle.joints.at(0);
  EXPECT_EQ(joint.type, sim::JointType::hinge);
  EXPECT_EQ(joint.first + " " + joint.second, "a b");
  EXPECT_TRUE(joint.axis_V.isApprox(Vector3d(-1, 0, 0), 1e-15)) << joint.axis_V;  // y of a frame at 90 degrees of yaw
  EXPECT_EQ(joint.low_stop, -1);
  EXPECT_EQ(joint.high_stop, 0.5);
  EXPECT_EQ(joint.servo_low, -1);
  EXPECT_EQ(joint.servo_high, 0.5);
  EXPECT_EQ(joint.max_effort, 3);
  EXPECT_EQ(joint.max_velocity, 4);
  EXPECT_EQ(notes_of(vehicle), "");
}

TEST(ImportedVehicle, MakesASliderOfAPrismaticJointWithTheDefaultAxis) {
  const tools::ImportedVehicle vehicle = imported(
      pair_text("prismatic", "<limit lower=\"-0.1\" upper=\"7\" effort=\"3\" velocity=\"4\" acceleration=\"5\"/>"));
  const tools::ImportedJoint& joint = vehicle.joints.at(0);
  EXPECT_EQ(joint.type, sim::JointType::slider);
  EXPECT_EQ(joint.axis_V, Vector3d::UnitX());
  EXPECT_EQ(joint.high_stop, 7);  // m
  EXPECT_EQ(joint.max_acceleration, 5);
}

TEST(ImportedVehicle, MakesAHingeWithoutStopsOfAContinuousJoint) {
  const tools::ImportedVehicle vehicle =
      imported(pair_text("continuous", "<axis xyz=\"0 1 0\"/><limit effort=\"3\" velocity=\"4\"/>"));
  const tools::ImportedJoint& joint = vehicle.joints.at(0);
  EXPECT_EQ(joint.type, sim::JointType::hinge);
  EXPECT_FALSE(joint.low_stop || joint.high_stop || joint.servo_low || joint.servo_high);
  EXPECT_EQ(joint.max_velocity, 4);
}

TEST(ImportedVehicle, GivesNoServoToAJointWithoutEffort) {
  const tools::ImportedVehicle without = imported(pair_text("continuous"));
  EXPECT_FALSE(without.joints.at(0).max_velocity);
  EXPECT_EQ(notes_of(without),
            "r.urdf:4: joint 'j' gets no servo: that needs a <limit> with effort and velocity above 0\n");
  const tools::ImportedVehicle zero =
      imported(pair_text("revolute", "<limit lower=\"-1\" upper=\"1\" effort=\"0\" velocity=\"1\"/>"));
  EXPECT_FALSE(zero.joints.at(0).max_effort);
  EXPECT_EQ(zero.joints.at(0).low_stop, -1);
}

TEST(ImportedVehicle, LimitsTheServoWhereAStopCannotBe) {
  // Beyond two turns, which is the range of a stop; and beyond zero, where a run starts.
  const tools::ImportedVehicle wide =
      imported(pair_text("revolute", "<limit lower=\"-13\" upper=\"1\" effort=\"1\" velocity=\"1\"/>"));
  EXPECT_EQ(wide.joints.at(0).low_stop, std::nullopt);
  EXPECT_EQ(wide.joints.at(0).servo_low, -13);
  EXPECT_EQ(wide.joints.at(0).high_stop, 1);
  EXPECT_EQ(notes_of(wide), "r.urdf:4: joint 'j': its limit -13 limits only its servo: a stop is at most two turns\n");
  const tools::ImportedVehicle bent =
      imported(pair_text("revolute", "<limit lower=\"-2\" upper=\"-0.5\" effort=\"1\" velocity=\"1\"/>"));
  EXPECT_EQ(bent.joints.at(0).low_stop, -2);
  EXPECT_EQ(bent.joints.at(0).high_stop, std::nullopt);
  EXPECT_EQ(bent.joints.at(0).servo_high, -0.5);
  EXPECT_THAT(notes_of(bent), HasSubstr("its limit -0.5 limits only its servo: zero, where a run starts"));
}

TEST(ImportedVehicle, TakesTheSoftLimitsOfASafetyController) {
  const tools::ImportedVehicle vehicle =
      imported(pair_text("revolute",
                         "<limit lower=\"-1\" upper=\"2\" effort=\"1\" velocity=\"1\"/>"
                         "<safety_controller soft_lower_limit=\"-0.9\" soft_upper_limit=\"3\" k_velocity=\"1\"/>"));
  EXPECT_EQ(vehicle.joints.at(0).servo_low, -0.9);
  EXPECT_EQ(vehicle.joints.at(0).servo_high, 2);  // not beyond the stop
  EXPECT_EQ(vehicle.joints.at(0).low_stop, -1);
}

}  // namespace
