// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/shoal/urdf/urdf_texts.hpp"
#include "tools/shoal/urdf/imported_meshes.hpp"
#include "tools/shoal/urdf/urdf_reader.hpp"

namespace {

using test::import_error;
using test::imported;
using test::notes_of;
using test::pair_text;
using testing::HasSubstr;

tools::ImportedVehicle with_limit(const std::string& limit) {
  return imported(pair_text("revolute", "<limit " + limit + "/>"));
}

TEST(DecorativeFault, AttributesThatAreNotImportedAreNoted) {
  EXPECT_EQ(notes_of(with_limit("lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"2\" acceleration=\"3\"")),
            "r.urdf:4: joint 'j': 'acceleration' of <limit> is not imported\n");
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

const std::string range = R"(<limit lower="-1" upper="2" effort="3" velocity="4"/>)";

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

}  // namespace
