// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/imported_vehicle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/tools/shoal/urdf/urdf_texts.hpp"

namespace {

using sim::Matrix3d;
using sim::Vector3d;
using test::imported;
using test::link_text;
using test::notes_of;
using test::pair_text;
using test::robot_text;
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

TEST(ImportedVehicle, MergesAFixedLinkIntoItsParent) {
  // b is at (1, 0, 0) in a, turned by 90 degrees: its x is y of a, its y is -x of a.  Its center of mass, (0.5, 0, 0),
  // is at (1, 0.5, 0) in a; its box, at (0, 0.2, 0), is at (0.8, 0, 0).  The hinge c is at (0, 0, 0.3) in b, rolled by
  // 90 degrees: its axis y is z of b and of a.
  const tools::ImportedVehicle vehicle = imported(robot_text(
      "<link name=\"a\"><inertial><mass value=\"2\"/><inertia ixx=\"0.2\" iyy=\"0.3\" izz=\"0.4\"/></inertial></link>\n"
      "<link name=\"b\"><inertial><origin xyz=\"0.5 0 0\"/><mass value=\"1\"/>"
      "<inertia ixx=\"0.01\" iyy=\"0.02\" izz=\"0.03\"/></inertial>"
      "<collision><origin xyz=\"0 0.2 0\"/><geometry><box size=\"1 2 3\"/></geometry></collision></link>\n" +
      link_text("c") +
      "<joint name=\"ab\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/><origin xyz=\"1 0 0\" rpy=\"0 0 " +
      right_angle + "\"/></joint>\n<joint name=\"bc\" type=\"continuous\"><parent link=\"b\"/><child link=\"c\"/>" +
      "<origin xyz=\"0 0 0.3\" rpy=\"" + right_angle + " 0 0\"/><axis xyz=\"0 1 0\"/></joint>\n"));
  ASSERT_EQ(vehicle.bodies.size(), 2u);
  const tools::ImportedBody& body = vehicle.bodies[0];
  EXPECT_EQ(body.name, "a");
  EXPECT_DOUBLE_EQ(body.mass_kg, 3);
  EXPECT_TRUE(body.center_of_mass_m.isApprox(Vector3d(1.0 / 3, 1.0 / 6, 0), 1e-12)) << body.center_of_mass_m;
  // Two masses at d = (1, 0.5, 0) from each other have the reduced mass 2 * 1 / 3: it adds 2/3 (d^2 E - d d').
  Matrix3d inertia;
  inertia << 0.2 + 0.02 + 2.0 / 3 * 0.25, -2.0 / 3 * 0.5, 0,  //
      -2.0 / 3 * 0.5, 0.3 + 0.01 + 2.0 / 3, 0,                //
      0, 0, 0.4 + 0.03 + 2.0 / 3 * 1.25;
  EXPECT_TRUE(body.inertia_kgm2.isApprox(inertia, 1e-12)) << body.inertia_kgm2;
  EXPECT_TRUE(body.parts.at(0).X_BP.isApprox(sim::make_pose({0.8, 0, 0}, {0, 0, std::numbers::pi / 2}), 1e-12));
  EXPECT_EQ(body.parts[0].shape.name, "b");
  // The joint connects the merged body.
  ASSERT_EQ(vehicle.joints.size(), 1u);
  EXPECT_EQ(vehicle.joints[0].first, "a");
  EXPECT_TRUE(vehicle.joints[0].axis_V.isApprox(Vector3d::UnitZ(), 1e-12)) << vehicle.joints[0].axis_V;
  EXPECT_TRUE(vehicle.bodies[1].X_VB.translation().isApprox(Vector3d(1, 0, 0.3), 1e-12));
}

TEST(ImportedVehicle, TurnsTheInertiaOfARotatedInertialFrame) {
  // Rolled by 90 degrees y becomes z; with 45 degrees of yaw of diag(1, 2, 2.5), Ixx = Iyy = 1.5 and Ixy = (1 - 2) / 2.
  const auto inertia_at = [](const std::string& rpy) {
    return imported(robot_text("<link name=\"a\"><inertial><origin rpy=\"" + rpy +
                               "\"/><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"2\" izz=\"2.5\"/></inertial></link>"))
        .bodies.at(0)
        .inertia_kgm2;
  };
  EXPECT_TRUE(inertia_at(right_angle + " 0 0").isApprox(Matrix3d(Vector3d(1, 2.5, 2).asDiagonal()), 1e-12));
  Matrix3d yawed;
  yawed << 1.5, -0.5, 0, -0.5, 1.5, 0, 0, 0, 2.5;
  EXPECT_TRUE(inertia_at("0 0 0.78539816339744831").isApprox(yawed, 1e-12));
}

TEST(ImportedVehicle, ShowsVisualShapesOnlyOfLinksWithoutCollisionShapes) {
  const std::string ball = "<geometry><sphere radius=\"1\"/></geometry>",
                    box = "<geometry><box size=\"1 1 1\"/></geometry>";
  const tools::ImportedVehicle both = imported(robot_text(link_text(
      "a", "<visual>" + ball + "<material name=\"m\"><color rgba=\"0 1 0 1\"/></material></visual>\n<collision>" + box +
               "</collision>")));
  ASSERT_EQ(both.bodies.at(0).parts.size(), 1u);
  EXPECT_EQ(both.bodies[0].parts[0].shape.shape, sim::PartShape::box);
  EXPECT_EQ(both.bodies[0].parts[0].shape.color, "#00ff00");
  EXPECT_EQ(notes_of(both), "r.urdf:2: link 'a': <visual> is not imported: the shapes of <collision> are shown\n");
  const tools::ImportedVehicle one = imported(robot_text(link_text("a", "<visual>" + ball + "</visual>")));
  EXPECT_TRUE(one.bodies.at(0).parts.at(0).only_visual);
  EXPECT_EQ(notes_of(one), "");
}

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

TEST(ImportedVehicle, NamesAreThoseThatShoalAccepts) {
  const tools::ImportedVehicle vehicle = imported(robot_text(
      link_text("base link") + link_text("base.link") +
      "<joint name=\"joints\" type=\"continuous\"><parent link=\"base link\"/><child link=\"base.link\"/></joint>"));
  EXPECT_EQ(vehicle.bodies[0].name, "base_link");
  EXPECT_EQ(vehicle.bodies[1].name, "base_link_2");
  EXPECT_EQ(vehicle.joints[0].name, "joints_2");  // `joints` is the device that reports them
  EXPECT_THAT(notes_of(vehicle), HasSubstr("r.urdf:3: link 'base.link' is named 'base_link_2' in Shoal\n"));
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

TEST(ImportedVehicle, WarnsOfAnInertiaThatNoSolidHas) {
  EXPECT_THAT(notes_of(imported(robot_text("<link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" "
                                           "izz=\"3\"/></inertial></link>"))),
              HasSubstr("r.urdf:2: body 'a': no solid has its moments of inertia, 1, 1 and 3 kg m^2"));
}

}  // namespace
