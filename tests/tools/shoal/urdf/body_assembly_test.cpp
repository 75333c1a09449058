// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/body_assembly.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/tools/shoal/urdf/urdf_texts.hpp"
#include "tools/shoal/urdf/imported_vehicle.hpp"

namespace {

using sim::Matrix3d;
using sim::Vector3d;
using test::imported;
using test::link_text;
using test::notes_of;
using test::robot_text;
using testing::HasSubstr;

const std::string right_angle = "1.5707963267948966";  // pi / 2

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

TEST(ImportedVehicle, WarnsOfAnInertiaThatNoSolidHas) {
  EXPECT_THAT(notes_of(imported(robot_text("<link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" "
                                           "izz=\"3\"/></inertial></link>"))),
              HasSubstr("r.urdf:2: body 'a': no solid has its moments of inertia, 1, 1 and 3 kg m^2"));
}

}  // namespace
