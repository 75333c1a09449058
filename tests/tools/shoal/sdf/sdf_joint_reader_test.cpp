// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/tools/shoal/sdf/sdf_texts.hpp"

namespace {

using namespace test;
using testing::HasSubstr;

/// A pair whose child is at (1, 0, 0), turned by 90 degrees about z.
tools::ImportedJoint joint_of(const std::string& type, const std::string& more, const std::string& version = "1.9") {
  const std::string pose = "<pose>1 0 0 0 0 1.5707963267948966</pose>";
  return imported_sdf(sdf_text(sdf_link("a") + sdf_link("b", pose) + sdf_joint(type, more), version))
      .vehicle.joints.at(0);
}

TEST(SdfJointReader, TurnsAxesFromTheFrameOfTheJoint) {
  const tools::ImportedJoint joint = joint_of("revolute", "<axis><xyz>1 0 0</xyz></axis>");
  EXPECT_EQ(joint.type, sim::JointType::hinge);
  EXPECT_TRUE(joint.axis_V.isApprox(sim::Vector3d::UnitY(), 1e-12));  // x of b
  EXPECT_FALSE(joint.anchor_V);
  EXPECT_FALSE(joint.low_stop);
  // A joint with a pose has its point and its axes there: (0, 0.5, 0) of b is (0.5, 0, 0) of a; z of the joint is -y of
  // b.
  const tools::ImportedJoint posed =
      joint_of("continuous", "<pose>0 0.5 0 1.5707963267948966 0 0</pose><axis><xyz>0 0 1</xyz></axis>");
  EXPECT_TRUE(posed.anchor_V.value().isApprox(sim::Vector3d(0.5, 0, 0), 1e-12));
  EXPECT_TRUE(posed.axis_V.isApprox(sim::Vector3d::UnitX(), 1e-12));
}

TEST(SdfJointReader, TurnsAxesFromOtherFrames) {
  EXPECT_TRUE(joint_of("revolute", "<axis><xyz expressed_in=\"__model__\">1 0 0</xyz></axis>")
                  .axis_V.isApprox(sim::Vector3d::UnitX(), 1e-12));
  EXPECT_TRUE(
      joint_of("revolute", "<axis><xyz>1 0 0</xyz><use_parent_model_frame>1</use_parent_model_frame></axis>", "1.6")
          .axis_V.isApprox(sim::Vector3d::UnitX(), 1e-12));
  // Until 1.4 axes are in the frame of the model.
  EXPECT_TRUE(
      joint_of("revolute", "<axis><xyz>1 0 0</xyz></axis>", "1.4").axis_V.isApprox(sim::Vector3d::UnitX(), 1e-12));
}

TEST(SdfJointReader, ReadsLimitsAndDynamics) {
  const tools::ImportedJoint joint =
      joint_of("prismatic",
               "<axis><xyz>0 0 1</xyz><limit><lower>-0.5</lower><upper>0.25</upper><effort>30</effort>"
               "<velocity>2</velocity></limit><dynamics><damping>3</damping><friction>4</friction></dynamics></axis>");
  EXPECT_EQ(joint.type, sim::JointType::slider);
  EXPECT_DOUBLE_EQ(joint.low_stop.value(), -0.5);
  EXPECT_DOUBLE_EQ(joint.high_stop.value(), 0.25);
  EXPECT_TRUE(joint.has_servo());
  EXPECT_DOUBLE_EQ(joint.max_effort.value(), 30);
  EXPECT_DOUBLE_EQ(joint.damping, 3);
  EXPECT_DOUBLE_EQ(joint.friction, 4);
  // 1e16 and -1 are none.
  const tools::ImportedJoint free = joint_of(
      "revolute",
      "<axis><xyz>0 0 1</xyz><limit><lower>-1e16</lower><upper>1e16</upper><effort>-1</effort></limit></axis>");
  EXPECT_FALSE(free.low_stop);
  EXPECT_FALSE(free.has_servo());
}

TEST(SdfJointReader, ReadsBallsAndUniversals) {
  EXPECT_EQ(joint_of("ball", "").type, sim::JointType::ball);
  const tools::ImportedJoint universal =
      joint_of("universal", "<axis><xyz>0 0 1</xyz></axis><axis2><xyz>1 0 0</xyz></axis2>");
  EXPECT_EQ(universal.type, sim::JointType::universal);
  EXPECT_TRUE(universal.axis2_V.value().isApprox(sim::Vector3d::UnitY(), 1e-12));
}

TEST(SdfJointReader, LeavesOutScrewsAndRefusesWhatIsWrong) {
  const tools::RobotImport import = imported_sdf(sdf_text(sdf_link("a") + sdf_link("b") + sdf_joint("screw")));
  EXPECT_EQ(import.vehicle.bodies.size(), 1u);
  EXPECT_THAT(notes_of(import.vehicle),
              HasSubstr("m.sdf:4: joint 'j' of type 'screw' is not imported: Shoal has none like it\n"));
  const auto error = [](const std::string& more) {
    return sdf_error(sdf_text(sdf_link("a") + sdf_link("b") + sdf_joint("revolute", more)));
  };
  EXPECT_EQ(error("<axis><xyz>0 0 0</xyz></axis>"), "m.sdf:4: joint 'j': the axis must not be zero");
  EXPECT_EQ(error("<axis><limit><lower>1</lower><upper>0</upper></limit></axis>"),
            "m.sdf:4: joint 'j': <lower> must not be above <upper>, got 1 and 0");
  EXPECT_EQ(error(""), "m.sdf:4: joint 'j': <joint> needs a <axis>");
}

}  // namespace
