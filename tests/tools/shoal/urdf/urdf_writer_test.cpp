// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_writer.hpp"

#include <gmock/gmock.h>

#include "tests/tools/shoal/urdf/urdf_texts.hpp"

namespace {

using namespace test;
using testing::HasSubstr;

TEST(UrdfWriter, WritesWhatTheReaderReads) {
  const std::string text = robot_text(
      "<link name=\"a\"><inertial><origin xyz=\"0.1 0.2 0.3\"/><mass value=\"1.25\"/><inertia ixx=\"1\" ixy=\"0.1\" "
      "ixz=\"0.2\" iyy=\"2\" iyz=\"0.3\" izz=\"2.5\"/></inertial>"
      "<collision name=\"hull\"><origin xyz=\"0 0 1\" rpy=\"0.1 0.2 0.3\"/><geometry><capsule radius=\"0.1\" "
      "length=\"0.7\"/></geometry></collision>"
      "<visual name=\"hull\"><geometry><box size=\"1 2 3\"/></geometry><material name=\"m\"><color rgba=\"1 "
      "0.5019607843 "
      "0 1\"/></material></visual></link>\n" +
      link_text("b") + link_text("c") +
      joint_text(
          "revolute",
          "<origin xyz=\"1 2 3\"/><axis xyz=\"0 1 0\"/><limit lower=\"-1\" upper=\"2\" effort=\"3\" velocity=\"4\"/>"
          "<dynamics damping=\"0.5\" friction=\"0.25\"/>") +
      "<joint name=\"k\" type=\"prismatic\"><parent link=\"a\"/><child link=\"c\"/><axis xyz=\"0 0 1\"/><limit "
      "lower=\"0\" "
      "upper=\"1\" effort=\"3\" velocity=\"4\"/><mimic joint=\"j\" multiplier=\"2\" offset=\"0.5\"/></joint>\n");
  const tools::RobotDescription robot = tools::read_urdf(text, "r.urdf");
  const std::string written = tools::urdf_text(robot);
  const tools::RobotDescription again = tools::read_urdf(written, "again.urdf");
  EXPECT_EQ(tools::urdf_text(again), written);
  ASSERT_EQ(again.links.size(), 3u);
  EXPECT_DOUBLE_EQ(again.links[0].inertial->mass_kg, 1.25);
  EXPECT_TRUE(again.links[0].inertial->inertia_kgm2.isApprox(robot.links[0].inertial->inertia_kgm2, 1e-15));
  EXPECT_EQ(again.links[0].collisions.at(0).name, "hull");
  EXPECT_TRUE(again.links[0].collisions[0].X_LS.isApprox(robot.links[0].collisions[0].X_LS, 1e-12));
  EXPECT_EQ(again.links[0].visuals.at(0).color, "#ff8000");
  EXPECT_DOUBLE_EQ(again.joints.at(0).upper.value(), 2);
  EXPECT_DOUBLE_EQ(again.joints[0].friction, 0.25);
  EXPECT_DOUBLE_EQ(again.joints.at(1).mimic->multiplier, 2);
  EXPECT_TRUE(again.notes.empty());
}

TEST(UrdfWriter, EscapesNames) {
  tools::RobotDescription robot;
  robot.name = "a<b>&\"c\"";
  robot.links.push_back({.name = "l", .inertial = {}, .collisions = {}, .visuals = {}, .place = {}});
  EXPECT_THAT(tools::urdf_text(robot), HasSubstr("name=\"a&lt;b>&amp;&quot;c&quot;\""));
  EXPECT_EQ(tools::read_urdf(tools::urdf_text(robot), "r.urdf").name, robot.name);
}

}  // namespace
