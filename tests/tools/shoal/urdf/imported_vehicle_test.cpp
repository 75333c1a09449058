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

}  // namespace
