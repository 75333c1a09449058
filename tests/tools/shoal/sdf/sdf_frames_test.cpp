// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/sdf/sdf_frames.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "tests/tools/shoal/sdf/sdf_texts.hpp"

namespace {

using namespace test;
using testing::HasSubstr;

/// Center of the box of link `b` in the vehicle's frame: V, as `a` is at its origin.
sim::Vector3d place_of_b(const std::string& model) {
  const tools::RobotImport import = imported_sdf(model);
  for (const tools::ImportedBody& body : import.vehicle.bodies)
    if (body.name == "b") return body.X_VB.translation();
  throw std::runtime_error("no body b");
}

std::string pair_of(const std::string& pose_of_b, const std::string& more = "") {
  return sdf_text(sdf_link("a") + sdf_link("b", pose_of_b) + sdf_joint("revolute", "<axis><xyz>0 0 1</xyz></axis>") +
                  more);
}

TEST(SdfFrames, ArePosedRelativeToTheModelOrAFrame) {
  EXPECT_TRUE(place_of_b(pair_of("<pose>1 2 3 0 0 0</pose>")).isApprox(sim::Vector3d(1, 2, 3)));
  // A frame at (1, 0, 0), turned by 90 degrees about z: its y axis is -x.
  const std::string frame = "<frame name=\"f\"><pose degrees=\"true\">1 0 0 0 0 90</pose></frame>\n";
  EXPECT_TRUE(
      place_of_b(pair_of("<pose relative_to=\"f\">0 2 0 0 0 0</pose>", frame)).isApprox(sim::Vector3d(-1, 0, 0)));
  // A frame attached to one is posed in it.
  const std::string second = frame + "<frame name=\"g\" attached_to=\"f\"><pose>0 0 5 0 0 0</pose></frame>\n";
  EXPECT_TRUE(
      place_of_b(pair_of("<pose relative_to=\"g\">0 2 0 0 0 0</pose>", second)).isApprox(sim::Vector3d(-1, 0, 5)));
}

TEST(SdfFrames, TakeAQuaternion) {
  // 90 degrees about x turn y to z.
  const std::string frame =
      "<frame name=\"f\"><pose rotation_format=\"quat_xyzw\">0 0 0 0.70710678118654752 0 0 "
      "0.70710678118654752</pose></frame>\n";
  EXPECT_TRUE(
      place_of_b(pair_of("<pose relative_to=\"f\">0 2 0 0 0 0</pose>", frame)).isApprox(sim::Vector3d(0, 0, 2), 1e-12));
  EXPECT_EQ(sdf_error(pair_of("<pose rotation_format=\"quat_xyzw\">0 0 0 1 1 0 0</pose>")),
            "m.sdf:3: the quaternion of <pose> must have the length 1, got 1.4142135623730951");
}

TEST(SdfFrames, OfNestedModelsAreScoped) {
  const auto body_of = [](const std::string& attributes) {
    const tools::RobotImport import = imported_sdf(
        sdf_text(sdf_link("a") + "<model name=\"n\"" + attributes + "><pose>0 0 10 0 0 0</pose>" +
                 sdf_link("b", "<pose>1 0 0 0 0 0</pose>") + "</model>\n" +
                 sdf_joint("revolute", "<axis><xyz>0 0 1</xyz></axis>", "<parent>a</parent><child>n::b</child>")));
    return import.vehicle.bodies.at(1);
  };
  EXPECT_EQ(body_of("").name, "n__b");
  EXPECT_TRUE(body_of("").X_VB.translation().isApprox(sim::Vector3d(1, 0, 10)));
  // With a placement frame the pose is that of this frame: b is at it.
  EXPECT_TRUE(body_of(" placement_frame=\"b\"").X_VB.translation().isApprox(sim::Vector3d(0, 0, 10)));
}

TEST(SdfFrames, ThatAreDefinedByEachOtherAreRefused) {
  const std::string loop =
      "<frame name=\"f\"><pose relative_to=\"g\"/></frame>\n<frame name=\"g\"><pose relative_to=\"f\"/></frame>\n";
  EXPECT_THAT(sdf_error(pair_of("<pose relative_to=\"f\"/>", loop)), HasSubstr("is defined by itself"));
  EXPECT_THAT(sdf_error(pair_of("<pose relative_to=\"b\"/>")), HasSubstr("frame 'b' is defined by itself"));
  EXPECT_THAT(sdf_error(pair_of("<pose relative_to=\"none\"/>")),
              HasSubstr("there is no link, joint, frame or model 'none'"));
  EXPECT_THAT(sdf_error(sdf_text(sdf_link("a") + sdf_link("a"))), HasSubstr("m.sdf:3: the name 'a' is taken"));
}

}  // namespace
