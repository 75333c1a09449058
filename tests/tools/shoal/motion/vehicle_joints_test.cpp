// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/vehicle_joints.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "sim/config/diagnostics.hpp"
#include "tests/tools/shoal/motion/leg_files.hpp"

namespace {

TEST(VehicleJoints, AJointThatAMotionLeavesOutRestsWhereItParksWithinItsRange) {
  const test::LegFiles files;
  const motion::JointNames names = tools::joint_names_of(files.path("leg.yaml"), "");
  ASSERT_EQ(names.joints().size(), 3u);
  EXPECT_EQ(names.find("maker/knee"), names.find("knee"));
  EXPECT_EQ(names.find("knee")->rest, 0);
  EXPECT_FALSE(names.find("knee")->is_slider);
  EXPECT_EQ(names.find("rod")->rest, 0.1) << "its stop, not the 0.3 m at which it would park";
  EXPECT_TRUE(names.find("rod")->is_slider);
  EXPECT_TRUE(names.find("lamp")->is_light);
}

TEST(VehicleJoints, TheirNamesElsewhereAreInAFileBesideTheVehicle) {
  const test::LegFiles files;
  const std::string lists = "shoal: 1\njoint_names: leg\nlists: [{list: tekkotsu, joints: {knee: ";
  std::filesystem::create_directory(files.path("joint_names"));
  files.write("joint_names/leg.yaml", lists + "KNEE}}]\n");
  const std::string other = files.write("other.yaml", lists + "KNIE}}]\n");
  const auto name = [&](const std::string& names_file) {
    return tools::joint_names_of(files.path("leg.yaml"), names_file).foreign_name("tekkotsu", false, "knee");
  };
  EXPECT_EQ(name(""), "KNEE");
  EXPECT_EQ(name(other), "KNIE");
}

TEST(VehicleJoints, AVehicleWithoutAServoHasNoMotion) {
  const test::LegFiles files;
  const std::string crate = files.write(
      "crate.yaml",
      "shoal: 1\nvehicle: crate\nbodies: [{name: box, parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1}]}]\n");
  EXPECT_THAT([&] { tools::joint_names_of(crate, ""); },
              testing::ThrowsMessage<sim::ConfigError>(testing::HasSubstr("the vehicle has no joint_servo")));
}

TEST(VehicleJoints, TheVehicleOfAMotionIsBesideItElseAShippedOne) {
  const test::LegFiles files;
  EXPECT_EQ(tools::vehicle_file_of("leg", files.path("bend.yaml")), files.path("leg.yaml"));
  EXPECT_EQ(tools::vehicle_file_of("leg", files.path("leg.yaml")), "") << "a motion is not its own vehicle";
  EXPECT_EQ(std::filesystem::path(tools::vehicle_file_of("ers7", files.path("bend.yaml"))).filename(), "ers7.yaml");
  EXPECT_EQ(tools::vehicle_file_of("no_such_robot", files.path("bend.yaml")), "");
  EXPECT_EQ(tools::vehicle_file_of("", files.path("bend.yaml")), "");
}

}  // namespace
