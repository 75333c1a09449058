// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/robot_tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/shoal/urdf/urdf_texts.hpp"
#include "tools/shoal/urdf/imported_meshes.hpp"

namespace {

using sim::Vector3d;
using test::import_error;
using test::imported;
using test::link_text;
using test::notes_of;
using test::robot_text;
using testing::HasSubstr;

std::string joint_between(const std::string& name, const std::string& type, const std::string& parent,
                          const std::string& child, const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + more + "</joint>\n";
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

TEST(DecorativeFault, TheWorldNeedsNoLink) {
  const tools::ImportedVehicle vehicle =
      imported(robot_text(link_text("a") + joint_between("weld", "fixed", "world", "a")));
  EXPECT_EQ(vehicle.joints.at(0).first + " " + vehicle.joints[0].second, "a world");
  EXPECT_EQ(notes_of(vehicle), "");
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

}  // namespace
