// SPDX-License-Identifier: BSD-3-Clause
// What other readers of URDF overlook: it gets a note, and the robot is imported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/urdf/urdf_texts.hpp"
#include "tools/shoal/urdf/imported_meshes.hpp"

namespace {

using sim::Vector3d;
using test::imported;
using test::link_text;
using test::notes_of;
using test::pair_text;
using test::robot_text;
using testing::HasSubstr;

const std::string unit_box = "<geometry><box size=\"1 1 1\"/></geometry>";

/// Robot of one link with a shape on line 3.
tools::ImportedVehicle with_shape(const std::string& kind, const std::string& content) {
  return imported(robot_text(link_text("a", "\n<" + kind + ">" + content + "</" + kind + ">\n")));
}

tools::ImportedVehicle with_limit(const std::string& limit) {
  return imported(pair_text("revolute", "<limit " + limit + "/>"));
}

std::string joint_between(const std::string& name, const std::string& type, const std::string& parent,
                          const std::string& child, const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + more + "</joint>\n";
}

TEST(DecorativeFault, AShapeWithoutVolumeIsLeftOut) {
  const auto expect_left_out = [](const std::string& geometry, const std::string& word) {
    for (const std::string kind : {"collision", "visual"}) {
      const tools::ImportedVehicle vehicle = with_shape(kind, "<geometry>" + geometry + "</geometry>");
      EXPECT_TRUE(vehicle.bodies.at(0).parts.empty());
      EXPECT_EQ(notes_of(vehicle), "r.urdf:3: link 'a': a <" + word + "> without volume is not imported\n");
    }
  };
  expect_left_out("<box size=\"0 0 0\"/>", "box");
  expect_left_out("<box size=\"1 0 1\"/>", "box");
  expect_left_out("<sphere radius=\"0\"/>", "sphere");
  expect_left_out("<sphere radius=\"1e-7\"/>", "sphere");
  expect_left_out("<cylinder radius=\"0.1\" length=\"0\"/>", "cylinder");
  expect_left_out("<mesh filename=\"m.stl\" scale=\"1 0 1\"/>", "mesh");
}

TEST(DecorativeFault, AttributesThatAreNotImportedAreNoted) {
  EXPECT_EQ(notes_of(with_limit("lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"2\" acceleration=\"3\"")),
            "r.urdf:4: joint 'j': 'acceleration' of <limit> is not imported\n");
}

TEST(DecorativeFault, AnOriginMayHaveAQuaternion) {
  const auto turned = [](const std::string& attributes) {
    return with_shape("collision", "<origin xyz=\"1 2 3\" " + attributes + "/>" + unit_box);
  };
  const tools::ImportedVehicle by_angles = turned("rpy=\"0 0 1.5707963267948966\"");
  const tools::ImportedVehicle by_quaternion = turned("quat_xyzw=\"0 0 0.70711 0.70711\"");
  const auto pose = [](const tools::ImportedVehicle& vehicle) { return vehicle.bodies.at(0).parts.at(0).X_BP; };
  EXPECT_TRUE(pose(by_quaternion).isApprox(pose(by_angles), 1e-9));
  EXPECT_THROW(turned("quat_xyzw=\"0 0 0 0\""), sim::ConfigError);
  EXPECT_THROW(turned("quat_xyzw=\"0 0 0 1\" rpy=\"0 0 1\""), sim::ConfigError);
}

TEST(DecorativeFault, OnlyTheFirstElementOfAGeometryCounts) {
  const tools::ImportedVehicle vehicle =
      with_shape("collision", "<geometry><sphere radius=\"0.5\"/>\n<origin xyz=\"1 0 0\"/></geometry>");
  EXPECT_EQ(vehicle.bodies.at(0).parts.at(0).shape.radius_m, 0.5);
  EXPECT_EQ(notes_of(vehicle), "r.urdf:4: link 'a': only the first element of a <geometry> is imported, <sphere>\n");
}

TEST(DecorativeFault, AVisualThatCannotBeReadIsLeftOut) {
  const tools::ImportedVehicle vehicle = with_shape("visual", "<geometry><cone/></geometry>");
  EXPECT_TRUE(vehicle.bodies.at(0).parts.empty());
  EXPECT_EQ(notes_of(vehicle),
            "r.urdf:3: link 'a': the shape must be one of: box, capsule, cylinder, mesh, sphere, got <cone>: this "
            "<visual> is not imported\n");
  EXPECT_THAT(notes_of(with_shape("visual", "")), HasSubstr("<visual> needs a <geometry>: this <visual>"));
  EXPECT_THAT(notes_of(with_shape("visual", "<geometry><sphere radius=\"-1\"/></geometry>")),
              HasSubstr("'radius' must be > 0, got -1: this <visual>"));
}

TEST(DecorativeFault, AColorIsBroughtIntoItsRange) {
  const auto color = [](const std::string& rgba) {
    const tools::ImportedVehicle vehicle =
        with_shape("visual", unit_box + "<material name=\"m\"><color rgba=\"" + rgba + "\"/></material>");
    return vehicle.bodies.at(0).parts.at(0).shape.color + " " + notes_of(vehicle);
  };
  const auto note = [](const std::string& rgba, const std::string& text) {
    return "r.urdf:3: 'rgba' must be four numbers from 0 to 1, got '" + rgba + "': " + text + "\n";
  };
  EXPECT_EQ(color("1 0.2 0 1"), "#ff3300 ");
  EXPECT_EQ(color("255 51 0 255"), "#ff3300 " + note("255 51 0 255", "it is taken as numbers up to 255"));
  EXPECT_EQ(color("255 51 0 1"), "#ff3300 " + note("255 51 0 1", "it is taken as numbers up to 255"));
  EXPECT_EQ(color("1.2 0.2 -1 1"), "#ff3300 " + note("1.2 0.2 -1 1", "it is limited to this range"));
  EXPECT_EQ(color("1 0.2 0"), "#ff3300 " + note("1 0.2 0", "it is opaque"));
  EXPECT_EQ(color("red"), " " + note("red", "the color is not imported"));
}

TEST(DecorativeFault, OnlyTheFirstOfTwoMaterialsCounts) {
  const tools::ImportedVehicle vehicle = with_shape(
      "visual", unit_box + "<material name=\"m\"><color rgba=\"1 0 0 1\"/></material>\n<material name=\"n\"/>");
  EXPECT_EQ(vehicle.bodies.at(0).parts.at(0).shape.color, "#ff0000");
  EXPECT_EQ(notes_of(vehicle), "r.urdf:4: link 'a': only the first <material> of a shape is imported\n");
}

TEST(DecorativeFault, AnUnknownMaterialOrATextureGivesNoColor) {
  const tools::ImportedVehicle unknown = with_shape("visual", unit_box + "<material name=\"steel\"/>");
  EXPECT_EQ(unknown.bodies.at(0).parts.at(0).shape.color, "");
  EXPECT_EQ(notes_of(unknown), "r.urdf:3: link 'a': the material 'steel' is not defined: its color is not imported\n");
  const tools::ImportedVehicle texture =
      with_shape("visual", unit_box + "<material name=\"m\"><texture filename=\"gone.png\"/></material>");
  EXPECT_EQ(notes_of(texture), "r.urdf:3: the texture of a material is not imported\n");
}

TEST(DecorativeFault, ALimitThatIsNoneGivesNoServo) {
  for (const std::string keys : {"effort=\"-1\" velocity=\"1\"", "effort=\"1\" velocity=\"-1\"",
                                 "effort=\"1e-300\" velocity=\"1\"", "velocity=\"1\"", "effort=\"1\""}) {
    const tools::ImportedVehicle vehicle = with_limit("lower=\"0\" upper=\"1\" " + keys);
    EXPECT_FALSE(vehicle.joints.at(0).has_servo());
    EXPECT_EQ(vehicle.joints[0].high_stop, 1);
    EXPECT_THAT(notes_of(vehicle), HasSubstr("of <limit> must be > 0, got ")) << keys;
    EXPECT_THAT(notes_of(vehicle), HasSubstr("it is taken as unknown\n")) << keys;
  }
}

TEST(DecorativeFault, AJointWithoutLimitMovesWithoutBounds) {
  const tools::ImportedVehicle vehicle = imported(pair_text("prismatic"));
  EXPECT_FALSE(vehicle.joints.at(0).low_stop || vehicle.joints[0].high_stop || vehicle.joints[0].has_servo());
  EXPECT_THAT(notes_of(vehicle), HasSubstr("r.urdf:4: joint 'j' has no <limit>: it moves without bounds\n"));
}

TEST(DecorativeFault, ALimitWithoutBoundsIsLimited) {
  const tools::ImportedVehicle vehicle =
      with_limit("lower=\"-1e+16\" upper=\"inf\" effort=\"1.7e308\" velocity=\"1e10\"");
  EXPECT_EQ(vehicle.joints.at(0).low_stop, std::nullopt);
  EXPECT_EQ(vehicle.joints[0].high_stop, std::nullopt);
  EXPECT_EQ(vehicle.joints[0].max_effort, 1e9);
  EXPECT_EQ(vehicle.joints[0].max_velocity, 1e9);
}

TEST(DecorativeFault, AFloatingJointOfTheRootLeavesTheVehicleFree) {
  for (const std::string type : {"floating", "planar"})
    for (const std::string root : {"world", "odom"}) {
      const std::string urdf = robot_text("<link name=\"" + root + "\"/>\n" + link_text("b") + link_text("c") +
                                          joint_between("f", type, root, "b", "<origin xyz=\"0 0 2\"/>") +
                                          joint_between("j", "continuous", "b", "c"));
      const tools::ImportedVehicle vehicle = imported(urdf);
      ASSERT_EQ(vehicle.bodies.size(), 2u);
      EXPECT_EQ(vehicle.bodies[0].X_VB.translation(), Vector3d(0, 0, 2));
      ASSERT_EQ(vehicle.joints.size(), 1u);
      EXPECT_EQ(vehicle.joints[0].first + " " + vehicle.joints[0].second, "b c");
      EXPECT_THAT(notes_of(vehicle),
                  HasSubstr("r.urdf:5: joint 'f' of type '" + type + "' is not imported: the vehicle moves freely\n"));
      const tools::ImportedVehicle fixed = imported(urdf, tools::Base::fixed);
      EXPECT_EQ(fixed.joints.at(1).first + " " + fixed.joints[1].second, "b world");
    }
}

TEST(DecorativeFault, ALinkThatNothingConnectsIsLeftOut) {
  const tools::ImportedVehicle vehicle = imported(
      robot_text(link_text("spare") + link_text("tip") + joint_between("t", "continuous", "spare", "tip") +
                 link_text("a") + link_text("b") + link_text("c") + joint_between("j", "continuous", "a", "b") +
                 joint_between("k", "continuous", "b", "c") + "<link name=\"frame\"/>\n"));
  ASSERT_EQ(vehicle.bodies.size(), 3u);
  EXPECT_EQ(vehicle.bodies[0].name, "a");
  EXPECT_EQ(vehicle.joints.size(), 2u);
  EXPECT_THAT(notes_of(vehicle),
              HasSubstr("r.urdf:2: link 'spare' is not connected to 'a': neither it nor what it carries is imported\n"
                        "r.urdf:10: link 'frame' is not connected to 'a': neither it nor what it carries is"));
}

TEST(DecorativeFault, ALinkOfTwoParentsIsRefusedAlsoWhereNothingConnectsIt) {
  const std::string urdf =
      robot_text(link_text("a") + link_text("b") + link_text("c") + joint_between("j", "continuous", "a", "b") +
                 joint_between("k", "continuous", "b", "c") + link_text("spare") + link_text("tip") +
                 joint_between("s", "continuous", "spare", "tip") + joint_between("t", "continuous", "spare", "tip"));
  EXPECT_EQ(test::import_error(urdf),
            "r.urdf:10: joint 't': link 'tip' already has the parent joint 's': a URDF is a tree");
}

TEST(DecorativeFault, AnEndWithoutMassAndShapesIsLeftOut) {
  // A frame, and one behind it.  A mass of 1e-10 kg is none.
  const tools::ImportedVehicle vehicle = imported(
      robot_text(link_text("a") +
                 "<link name=\"b\"><inertial><mass value=\"1e-10\"/><inertia ixx=\"0\" iyy=\"0\" izz=\"0\"/></inertial>"
                 "</link>\n<link name=\"c\"/>\n" +
                 joint_between("ab", "continuous", "a", "b") + joint_between("bc", "continuous", "b", "c")));
  EXPECT_EQ(vehicle.bodies.size(), 1u);
  EXPECT_TRUE(vehicle.joints.empty());
  EXPECT_THAT(notes_of(vehicle), HasSubstr("r.urdf:3: body 'b' has neither mass nor shapes and carries nothing: it and "
                                           "its joint are not imported\n"));
}

TEST(DecorativeFault, AnEmptyMeshOrAVisualOneThatIsMissingIsLeftOut) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("empty.STL")) << std::string(80, ' ');
  std::ofstream(folder.file("empty.obj"));
  std::ofstream(folder.file("blank.dae")) << "\n";
  std::ofstream(folder.file("text.stl")) << "solid x\nendsolid x\n";
  std::ofstream(folder.file("none.stl")) << std::string(84, '\0');
  std::ofstream(folder.file("page.stl")) << "404: Not Found";
  std::ofstream(folder.file("bad.dae")) << "<COLLADA>";
  const auto convert = [&](const std::string& kind, const std::string& mesh) {
    const std::string path = folder.file("r.urdf");
    tools::ImportedVehicle vehicle =
        tools::vehicle_of(tools::read_urdf(robot_text(link_text("a", "<" + kind + "><geometry><mesh filename=\"" +
                                                                         mesh + "\"/></geometry></" + kind + ">")),
                                           path),
                          path);
    EXPECT_TRUE(tools::convert_meshes(vehicle, {}).empty());
    EXPECT_TRUE(vehicle.bodies.at(0).parts.empty());
    return notes_of(vehicle).substr(path.size());
  };
  for (const std::string file : {"empty.STL", "empty.obj", "blank.dae", "text.stl", "none.stl"})
    EXPECT_EQ(convert("collision", file), ":2: mesh '" + file + "' has no triangles: not imported\n");
  EXPECT_EQ(convert("visual", "gone.stl"), ":2: mesh 'gone.stl' does not exist: this <visual> is not imported\n");
  EXPECT_THAT(convert("visual", "bad.dae"), HasSubstr("this <visual> is not imported\n"));
  EXPECT_EQ(convert("visual", "package://p/m.stl"),
            ":2: the folder of package 'p' is unknown: give --package p=DIR: this <visual> is not imported\n");
  // What collides matters.
  EXPECT_THROW(convert("collision", "gone.stl"), sim::ConfigError);
  EXPECT_THROW(convert("collision", "page.stl"), sim::ConfigError);
}

TEST(DecorativeFault, EachVisualOfADamagedMeshGetsTheNoteOfTheFirst) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("bad.dae")) << "<COLLADA>";
  const std::string path = folder.file("r.urdf"),
                    visual = "\n<visual><geometry><mesh filename=\"bad.dae\"/></geometry></visual>";
  tools::ImportedVehicle vehicle =
      tools::vehicle_of(tools::read_urdf(robot_text(link_text("a", visual + visual)), path), path);
  EXPECT_TRUE(tools::convert_meshes(vehicle, {}).empty());
  ASSERT_EQ(vehicle.notes.size(), 2u);
  EXPECT_EQ(vehicle.notes[0].text, vehicle.notes[1].text);
  EXPECT_EQ(vehicle.notes[1].place.line, 4);
}

TEST(DecorativeFault, ARobotWithoutNameGetsThatOfTheFile) {
  const tools::ImportedVehicle vehicle = imported("<robot>\n" + link_text("a") + "</robot>");
  EXPECT_EQ(vehicle.name, "r");
  EXPECT_EQ(notes_of(vehicle), "r.urdf:1: the robot has no name: it gets that of the file\n");
}

TEST(DecorativeFault, TheWorldNeedsNoLink) {
  const tools::ImportedVehicle vehicle =
      imported(robot_text(link_text("a") + joint_between("weld", "fixed", "world", "a")));
  EXPECT_EQ(vehicle.joints.at(0).first + " " + vehicle.joints[0].second, "a world");
  EXPECT_EQ(notes_of(vehicle), "");
}

TEST(DecorativeFault, UnknownElementsAreNoted) {
  EXPECT_EQ(notes_of(imported(robot_text(link_text("a", "<sensor/>") +
                                         "<gazebo reference=\"a\"><mu1>1</mu1></gazebo>\n<actuator/>\n"))),
            "r.urdf:3: <gazebo> is not imported\nr.urdf:4: <actuator> is not imported\n"
            "r.urdf:2: link 'a': <sensor> is not imported\n");
}

}  // namespace
