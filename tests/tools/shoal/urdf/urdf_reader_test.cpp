// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/urdf/urdf_texts.hpp"

namespace {

using test::import_error;
using test::joint_text;
using test::link_text;
using test::pair_text;
using test::robot_text;
using testing::HasSubstr;

const std::string range = R"(<limit lower="-1" upper="2" effort="3" velocity="4"/>)";

std::string shape_error(const std::string& geometry) {
  return import_error(robot_text(link_text("a", "<collision><geometry>" + geometry + "</geometry></collision>")));
}

TEST(UrdfReader, ReadsShapesColorsAndTheCommentBeforeTheRobot) {
  const tools::UrdfRobot robot = tools::read_urdf(
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
  const tools::UrdfLink& link = robot.links.at(0);
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
            "r.urdf:2: the root element must be <robot>, got <sdf>; this is SDF");
  EXPECT_EQ(import_error("<mujoco/>"),
            "r.urdf:1: the root element must be <robot>, got <mujoco>; this is a model of MuJoCo");
  EXPECT_EQ(import_error(robot_text("")), "r.urdf:1: a robot needs a <link>");
}

TEST(UrdfReader, RefusesXacroWithAHint) {
  EXPECT_EQ(import_error(robot_text("<xacro:property name=\"x\" value=\"1\"/>\n")),
            "r.urdf:2: <xacro:property> is xacro, not URDF: run `xacro FILE > robot.urdf` first");
  EXPECT_EQ(shape_error("<sphere radius=\"${r}\"/>"),
            "r.urdf:2: link 'a': 'radius' is a xacro expression, '${r}': run `xacro FILE > robot.urdf` first");
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("arm.urdf.xacro");
  std::ofstream(path) << robot_text(link_text("a"));
  EXPECT_THROW(
      {
        try {
          tools::read_urdf_file(path);
        } catch (const sim::ConfigError& error) {
          EXPECT_EQ(error.what(), path + ": is xacro, not URDF: run `xacro " + path + " > robot.urdf` first");
          throw;
        }
      },
      sim::ConfigError);
}

TEST(UrdfReader, DoesNotExpandEntities) {
  const std::string urdf = "<!DOCTYPE robot [<!ENTITY file SYSTEM \"file:///etc/passwd\"> <!ENTITY x \"y\">]>\n" +
                           robot_text(link_text("a&x;&file;b"));
  const tools::UrdfRobot robot = tools::read_urdf(urdf, "r.urdf");
  EXPECT_EQ(robot.links.at(0).name, "a&x;&file;b");
  ASSERT_EQ(robot.notes.size(), 1u);
  EXPECT_EQ(robot.notes[0].text, "the document type is not read; its entities are not expanded");
}

TEST(UrdfReader, NamesLineRuleAndValueOfAWrongShape) {
  EXPECT_EQ(shape_error("<sphere radius=\"-1\"/>"), "r.urdf:2: link 'a': 'radius' must be > 0, got -1");
  EXPECT_EQ(shape_error("<sphere radius=\"1e8\"/>"),
            "r.urdf:2: link 'a': 'radius' must be at most 1e7 m, got 100000000");
  EXPECT_EQ(shape_error("<sphere/>"), "r.urdf:2: link 'a': <sphere> needs the attribute 'radius'");
  EXPECT_EQ(shape_error("<sphere radius=\"1 2\"/>"),
            "r.urdf:2: link 'a': 'radius' must be a number between -1e9 and 1e9, got '1 2'");
  EXPECT_EQ(shape_error("<box size=\"1 nan 1\"/>"),
            "r.urdf:2: link 'a': 'size' must be 3 numbers between -1e9 and 1e9, got '1 nan 1'");
  EXPECT_EQ(shape_error("<box size=\"1 -2 1\"/>"), "r.urdf:2: link 'a': 'size' must be > 0, got -2");
  EXPECT_EQ(shape_error("<cone/>"),
            "r.urdf:2: link 'a': the shape must be one of: box, capsule, cylinder, mesh, sphere, got <cone>");
  EXPECT_EQ(shape_error(""), "r.urdf:2: link 'a': <geometry> must have a shape");
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

TEST(UrdfReader, NamesLineRuleAndValueOfAWrongJoint) {
  EXPECT_EQ(import_error(pair_text("floating")),
            "r.urdf:4: joint 'j': a joint of type 'floating' can only lead from the root, a link without mass and "
            "shapes, to the one link that carries all others; Shoal has hinges and sliders");
  EXPECT_THAT(import_error(pair_text("planar")), HasSubstr("a joint of type 'planar' can only lead from the root"));
  EXPECT_EQ(import_error(pair_text("hinge")),
            "r.urdf:4: joint 'j': 'type' must be one of: continuous, fixed, floating, planar, prismatic, revolute, got "
            "'hinge'");
  EXPECT_EQ(import_error(pair_text("revolute", "\n<limit lower=\"1\" upper=\"0\" effort=\"1\" velocity=\"1\"/>")),
            "r.urdf:5: joint 'j': 'lower' must not be above 'upper', got 1 and 0");
  EXPECT_EQ(import_error(pair_text("revolute", "<limit lower=\"nan\" upper=\"1\" effort=\"1\" velocity=\"1\"/>")),
            "r.urdf:4: joint 'j': 'lower' must be a number, got 'nan'");
  EXPECT_EQ(import_error(pair_text("revolute", range + "<dynamics damping=\"-1\"/>")),
            "r.urdf:4: joint 'j': 'damping' must be >= 0, got -1");
  EXPECT_EQ(import_error(pair_text("revolute", range + "\n<axis xyz=\"0 0 0\"/>")),
            "r.urdf:5: joint 'j': the axis must not be zero");
  EXPECT_EQ(import_error(pair_text("fixed", "<parent link=\"a\"/>")),
            "r.urdf:4: joint 'j': has more than one <parent>");
}

TEST(UrdfReader, RefusesLinksThatAreNoTree) {
  const std::string a = link_text("a"), b = link_text("b"), c = link_text("c");
  const auto joint = [](const std::string& name, const std::string& parent, const std::string& child) {
    return "<joint name=\"" + name + "\" type=\"fixed\"><parent link=\"" + parent + "\"/><child link=\"" + child +
           "\"/></joint>\n";
  };
  EXPECT_EQ(import_error(robot_text(a + a)), "r.urdf:3: there are two links 'a'");
  EXPECT_EQ(import_error(robot_text(a + b + joint("j", "a", "b") + joint("j", "a", "b"))),
            "r.urdf:5: there are two joints 'j'");
  EXPECT_EQ(import_error(robot_text(a + joint("j", "a", "x"))), "r.urdf:3: joint 'j': there is no link 'x'");
  EXPECT_EQ(import_error(robot_text(a + b + c + joint("j", "a", "c") + joint("k", "b", "c"))),
            "r.urdf:6: joint 'k': link 'c' already has the parent joint 'j': a URDF is a tree");
  EXPECT_EQ(import_error(robot_text(a + b + joint("j", "a", "b") + joint("k", "b", "a"))),
            "r.urdf:2: each link has a parent: the joints form a loop");
  EXPECT_EQ(import_error(robot_text(a + b + c + joint("j", "b", "c") + joint("k", "c", "b"))),
            "r.urdf:3: link 'b': is in a loop of joints");
}

TEST(UrdfReader, BoundsSizeDepthAndCounts) {
  EXPECT_EQ(import_error(std::string(tools::max_urdf_bytes + 1, ' ')), "r.urdf: must be at most 16 MiB");
  std::string deep;
  for (int i = 0; i < 2000; ++i) deep += "<robot>";
  EXPECT_EQ(import_error(deep), "r.urdf:1: elements are nested too deeply");
  std::string links;
  for (std::size_t i = 0; i <= tools::max_urdf_links; ++i) links += "<link name=\"l" + std::to_string(i) + "\"/>";
  EXPECT_EQ(import_error(robot_text(links)), "r.urdf:1: a robot must have at most 2000 links, got 2001");
}

}  // namespace
