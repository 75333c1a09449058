// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/shoal/urdf/urdf_texts.hpp"
#include "tools/shoal/urdf/imported_meshes.hpp"

namespace {

using test::import_error;
using test::imported;
using test::link_text;
using test::notes_of;
using test::robot_text;

TEST(UrdfReader, ReadsShapesColorsAndTheCommentBeforeTheRobot) {
  const tools::RobotDescription robot = tools::read_urdf(
      "<?xml version=\"1.0\"?>\n<!-- A robot.\n     Its numbers are made up. -->\n<robot name=\"r\">\n"
      "<material name=\"red\"><color rgba=\"1 0 0.5 1\"/></material>\n<link name=\"a\">\n"
      "<collision name=\"k\"><origin xyz=\"1 2 3\"/><geometry><box size=\"0.1 0.2 0.3\"/></geometry></collision>\n"
      "<collision><geometry><cylinder radius=\"0.1\" length=\"0.5\"/></geometry></collision>\n"
      "<collision><geometry><sphere radius=\"0.3\"/></geometry></collision>\n"
      "<collision><geometry><mesh filename=\"m.stl\" scale=\"0.001 0.001 0.002\"/></geometry></collision>\n"
      "<visual><geometry><capsule radius=\"0.1\" length=\"0.4\"/></geometry><material name=\"red\"/></visual>\n"
      "</link></robot>",
      "r.urdf");
  EXPECT_EQ(robot.comment, (std::vector<std::string>{"A robot.", "Its numbers are made up."}));
  const tools::RobotLink& link = robot.links.at(0);
  ASSERT_EQ(link.collisions.size(), 4u);
  EXPECT_EQ(link.collisions[0].name, "k");
  EXPECT_EQ(link.collisions[0].place.text(), "r.urdf:7");
  EXPECT_EQ(link.collisions[0].size_m, sim::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(link.collisions[0].X_LS.translation(), sim::Vector3d(1, 2, 3));
  EXPECT_EQ(link.collisions[1].shape, sim::PartShape::cylinder);
  EXPECT_EQ(link.collisions[1].length_m, 0.5);
  EXPECT_EQ(link.collisions[2].radius_m, 0.3);
  EXPECT_EQ(link.collisions[3].mesh, "m.stl");
  EXPECT_EQ(link.collisions[3].scale, sim::Vector3d(0.001, 0.001, 0.002));
  EXPECT_EQ(link.visuals.at(0).shape, sim::PartShape::capsule);
  EXPECT_EQ(link.visuals.at(0).color, "#ff0080");  // 0.5 * 255 = 127.5, rounded up
}

TEST(UrdfReader, RefusesWhatIsNotUrdf) {
  EXPECT_EQ(import_error("<robot name=\"r\">\n<link>\n</robot>"), "r.urdf:2: is not well-formed XML");
  EXPECT_EQ(import_error(""), "r.urdf: is not well-formed XML");
  EXPECT_EQ(import_error("\n<sdf version=\"1.6\"/>"),
            "r.urdf:2: the root element must be <robot>, got <sdf>; this is SDF: use `shoal import sdf`");
  EXPECT_EQ(import_error("<mujoco/>"),
            "r.urdf:1: the root element must be <robot>, got <mujoco>; this is a model of MuJoCo");
  EXPECT_EQ(import_error(robot_text("")), "r.urdf:1: a robot needs a <link>");
}

TEST(UrdfReader, NamesLineRuleAndValueOfAWrongInertial) {
  const auto inertial_error = [](const std::string& inertial) {
    return import_error(robot_text("<link name=\"a\">\n<inertial>\n" + inertial + "</inertial></link>"));
  };
  EXPECT_EQ(inertial_error("<mass value=\"-2\"/>"), "r.urdf:4: link 'a': the mass must be >= 0 kg, got -2");
  EXPECT_EQ(inertial_error("<mass value=\"1\"/>"), "r.urdf:3: link 'a': <inertial> needs a <inertia>");
  EXPECT_EQ(inertial_error("<mass value=\"1\"/>\n<inertia ixx=\"1\" iyy=\"-1\" izz=\"1\"/>"),
            "r.urdf:5: link 'a': the moments of inertia must be >= 0 kg m^2, got -1");
  EXPECT_EQ(inertial_error("<mass value=\"1\"/>\n<inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"2\"/>"),
            "r.urdf:2: body 'a': its inertia must be positive definite, got the moments -1, 1 and 3 kg m^2");
  EXPECT_EQ(
      import_error(robot_text("<link name=\"a\"/>")),
      "r.urdf:2: body 'a': must have a mass of at least 1e-9 kg, got 0: its link, or one that a fixed joint attaches "
      "to it, needs an <inertial>; `--density 1000` gives it the mass of its shapes, and `--fixed-base` a root that "
      "needs none");
}

TEST(DecorativeFault, ARobotWithoutNameGetsThatOfTheFile) {
  const tools::ImportedVehicle vehicle = imported("<robot>\n" + link_text("a") + "</robot>");
  EXPECT_EQ(vehicle.name, "r");
  EXPECT_EQ(notes_of(vehicle), "r.urdf:1: the robot has no name: it gets that of the file\n");
}

TEST(DecorativeFault, UnknownElementsAreNoted) {
  EXPECT_EQ(notes_of(imported(robot_text(link_text("a", "<sensor/>") +
                                         "<gazebo reference=\"a\"><mu1>1</mu1></gazebo>\n<actuator/>\n"))),
            "r.urdf:3: <gazebo> is not imported\nr.urdf:4: <actuator> is not imported\n"
            "r.urdf:2: link 'a': <sensor> is not imported\n");
}

}  // namespace
