// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/tools/shoal/sdf/sdf_texts.hpp"

namespace {

using namespace test;
using testing::HasSubstr;

TEST(SdfLinkReader, TransformsARotatedInertia) {
  // Moments 1, 2, 3 in a frame that is turned by 90 degrees about z: 2, 1, 3 in the link.
  const tools::RobotImport import = imported_sdf(
      sdf_text("<link name=\"a\">" + sdf_mass(4, "1 2 3", "0.5 0 0 0 0 1.5707963267948966") + "</link>\n"));
  const tools::ImportedBody& body = import.vehicle.bodies.at(0);
  EXPECT_DOUBLE_EQ(body.mass_kg, 4);
  EXPECT_TRUE(body.center_of_mass_m.isApprox(sim::Vector3d(0.5, 0, 0)));
  EXPECT_TRUE(body.inertia_kgm2.isApprox(sim::Vector3d(2, 1, 3).asDiagonal().toDenseMatrix(), 1e-12));
}

TEST(SdfLinkReader, ReadsShapesAndColors) {
  const tools::RobotImport import = imported_sdf(
      sdf_text(sdf_link("a",
                        "<collision name=\"hull\"><pose>0 0 1 0 0 0</pose><geometry><cylinder><radius>0.2</radius>"
                        "<length>3</length></cylinder></geometry></collision>"
                        "<visual name=\"v\"><geometry><box><size>1 1 1</size></box></geometry>"
                        "<material><diffuse>1 0 0.5 1</diffuse></material></visual>")));
  const tools::ImportedPart& part = import.vehicle.bodies.at(0).parts.at(0);
  EXPECT_EQ(part.shape.shape, sim::PartShape::cylinder);
  EXPECT_EQ(part.shape.name, "hull");
  EXPECT_DOUBLE_EQ(part.shape.length_m, 3);
  EXPECT_EQ(part.shape.color, "#ff0080");
  EXPECT_DOUBLE_EQ(part.X_BP.translation().z(), 1);
}

TEST(SdfLinkReader, LeavesOutShapesThatShoalLacks) {
  const std::string ellipsoid =
      "<collision name=\"c\"><geometry><ellipsoid><radii>1 2 3</radii></ellipsoid></geometry></collision>";
  const std::string part =
      "<visual name=\"v\"><geometry><mesh><uri>m.dae</uri><submesh><name>s</name></submesh></mesh>"
      "</geometry></visual>";
  const tools::RobotImport import = imported_sdf(sdf_text(sdf_link("a", ellipsoid + part)));
  EXPECT_TRUE(import.vehicle.bodies.at(0).parts.empty());
  EXPECT_THAT(notes_of(import.vehicle),
              HasSubstr("m.sdf:2: link 'a': <ellipsoid> is not imported: a part of Shoal is a box, capsule, cylinder, "
                        "mesh or sphere\n"));
  EXPECT_THAT(notes_of(import.vehicle), HasSubstr("a <submesh> is not imported: the file would give the whole mesh"));
}

TEST(SdfLinkReader, ComputesAnInertiaOfItsCollisions) {
  // 2 by 1 by 1 m at 500 kg/m^3: 1000 kg, about x 1000 (1 + 1) / 12, about y and z 1000 (4 + 1) / 12.
  const tools::RobotImport import = imported_sdf(sdf_text(
      "<link name=\"a\"><inertial auto=\"true\"><density>500</density></inertial>" + sdf_box("2 1 1") + "</link>\n"));
  const tools::ImportedBody& body = import.vehicle.bodies.at(0);
  EXPECT_DOUBLE_EQ(body.mass_kg, 1000);
  EXPECT_NEAR(body.inertia_kgm2(0, 0), 2000.0 / 12, 1e-9);
  EXPECT_NEAR(body.inertia_kgm2(1, 1), 5000.0 / 12, 1e-9);
}

TEST(SdfLinkReader, GivesALinkWithoutInertialTheDefaultUnlessItIsAFrame) {
  const tools::RobotImport import =
      imported_sdf(sdf_text(sdf_link("a") + "<link name=\"b\"/>\n" + sdf_joint("fixed") + "<link name=\"c\"/>\n" +
                            "<joint name=\"k\" type=\"ball\"><parent>a</parent><child>c</child></joint>\n"));
  EXPECT_DOUBLE_EQ(import.vehicle.bodies.at(0).mass_kg, 1);
  EXPECT_DOUBLE_EQ(import.vehicle.bodies.at(1).mass_kg, 1);
  EXPECT_THAT(
      notes_of(import.vehicle),
      HasSubstr("m.sdf:3: link 'b' has no <inertial>: it has no mass, where Gazebo gives it 1 kg and 1 kg m^2\n"));
  EXPECT_THAT(notes_of(import.vehicle),
              HasSubstr("m.sdf:5: link 'c' has no <inertial>: it has 1 kg and 1 kg m^2, the default of SDF\n"));
}

}  // namespace
