// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/tools/shoal/sdf/sdf_texts.hpp"

namespace {

using namespace test;
using testing::HasSubstr;

TEST(SdfTree, TurnsAJointThatLeadsToItsRoot) {
  // b carries a in the file, a is the canonical link: as seen from a the axis is reversed, and so is who moves.
  const tools::RobotImport import = imported_sdf(
      sdf_text(sdf_link("a") + sdf_link("b") +
               sdf_joint("revolute", "<axis><xyz>0 0 1</xyz><limit><lower>-0.5</lower><upper>1</upper></limit></axis>",
                         "<parent>b</parent><child>a</child>")));
  const tools::ImportedJoint& joint = import.vehicle.joints.at(0);
  EXPECT_EQ(joint.first, "a");
  EXPECT_EQ(joint.second, "b");
  EXPECT_TRUE(joint.axis_V.isApprox(-sim::Vector3d::UnitZ()));
  EXPECT_DOUBLE_EQ(joint.low_stop.value(), -0.5);
}

TEST(SdfTree, LeavesOutAJointThatClosesALoop) {
  const tools::RobotImport import =
      imported_sdf(sdf_text(sdf_link("a") + sdf_link("b") + sdf_link("c") + sdf_joint("ball") +
                            "<joint name=\"k\" type=\"ball\"><parent>b</parent><child>c</child></joint>\n"
                            "<joint name=\"l\" type=\"ball\"><parent>c</parent><child>a</child></joint>\n"));
  EXPECT_EQ(import.vehicle.joints.size(), 2u);
  EXPECT_THAT(notes_of(import.vehicle), HasSubstr("is not imported: it closes a loop of joints\n"));
}

TEST(SdfTree, FixesWhatIsFixedToTheWorld) {
  const tools::RobotImport import =
      imported_sdf(sdf_text(sdf_link("a", "<pose>0 0 2 0 0 0</pose>") + sdf_link("b") + sdf_joint("ball") +
                            "<joint name=\"k\" type=\"fixed\"><parent>world</parent><child>a</child></joint>\n"));
  EXPECT_DOUBLE_EQ(import.vehicle.bodies.at(0).X_VB.translation().z(), 2);
  EXPECT_THAT(import.text, HasSubstr("{name: k, type: fixed, bodies: [a, world]}"));
  // So is a static model.
  EXPECT_THAT(imported_sdf(sdf_text("<static>true</static>" + sdf_link("a"))).text,
              HasSubstr("type: fixed, bodies: [a, world]}"));
}

TEST(SdfTree, RefusesAJointWithoutLinks) {
  EXPECT_EQ(sdf_error(sdf_text(sdf_link("a") + sdf_joint("ball"))),
            "m.sdf:3: there is no link, joint, frame or model 'b'");
  EXPECT_EQ(sdf_error(sdf_text(sdf_link("a") + sdf_joint("ball", "", "<parent>a</parent><child>a</child>"))),
            "m.sdf:3: joint 'j': must connect two links, got twice the same");
}

}  // namespace
