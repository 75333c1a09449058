// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/vehicle_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "shoal/joint_servo_command_t.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/urdf/urdf_texts.hpp"

namespace {

using sim::Vector3d;
using test::imported;
using test::link_text;
using test::robot_text;
using testing::HasSubstr;

/// A world without gravity with an imported robot `v1` at the origin.
class ImportedWorld {
 public:
  explicit ImportedWorld(const std::string& urdf)
      : file_(write(imported(urdf))),
        world("shoal: 1\nphysics: {step_s: 0.001, gravity_mps2: 0}\nvehicles: [{name: v1, file: " + file_ + "}]") {}
  const sim::Vehicle& vehicle() const { return *world.world.find_vehicle("v1"); }

 private:
  std::string write(const tools::ImportedVehicle& vehicle) const {
    std::ofstream(folder_.file("v.yaml")) << tools::vehicle_text(vehicle, "");
    return folder_.file("v.yaml");
  }
  test_support::ScratchFolder folder_;
  std::string file_;

 public:
  test::TestWorld world;
};

std::string content_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(VehicleText, HoldsMassAndInertiaExactly) {
  // 10 digits in the file.
  const std::string urdf = robot_text(
      "<link name=\"a\"><inertial><origin xyz=\"0.1 -0.2 0.3\" rpy=\"0.4 0.5 0.6\"/><mass value=\"2.5\"/>"
      "<inertia ixx=\"0.02\" ixy=\"0.001\" ixz=\"-0.002\" iyy=\"0.03\" iyz=\"0.003\" izz=\"0.04\"/></inertial></link>");
  const ImportedWorld built(urdf);
  const sim::Body& body = built.vehicle().body("a");
  EXPECT_DOUBLE_EQ(body.mass_kg(), 2.5);
  EXPECT_TRUE(body.p_BC().isApprox(Vector3d(0.1, -0.2, 0.3), 1e-9));
  sim::Matrix3d inertia;
  inertia << 0.02, 0.001, -0.002, 0.001, 0.03, 0.003, -0.002, 0.003, 0.04;
  const sim::Matrix3d R = sim::rotation_from_rpy({0.4, 0.5, 0.6});
  EXPECT_TRUE(body.inertia_C_B().isApprox(R * inertia * R.transpose(), 1e-8)) << body.inertia_C_B();
}

TEST(VehicleText, MovesAJointAsTheUrdfSays) {
  // X_PC = X_PJ Rot(axis, q); the servo settles to the position within the softness of joints, cfm 1e-9.
  ImportedWorld built(
      robot_text(link_text("a") + link_text("b") +
                 test::joint_text("revolute",
                                  "<origin xyz=\"0.1 0.2 0.3\" rpy=\"0.3 -0.4 1.1\"/><axis xyz=\"1 2 -2\"/>"
                                  "<limit lower=\"-1\" upper=\"1\" effort=\"100\" velocity=\"2\"/>")));
  shoal::joint_servo_command_t message{};
  message.position = 0.7;
  built.world.send("v1.j.cmd", message);
  built.world.run_for(2);
  const sim::Pose X_PC = built.vehicle().body("a").X_WB().inverse() * built.vehicle().body("b").X_WB();
  const sim::Pose expected =
      sim::make_pose({0.1, 0.2, 0.3}, {0.3, -0.4, 1.1}) * Eigen::AngleAxisd(0.7, Vector3d(1, 2, -2).normalized());
  EXPECT_TRUE(X_PC.isApprox(expected, 1e-5)) << X_PC.matrix() << "\n\n" << expected.matrix();
}

TEST(VehicleText, DampsAJointAsTheUrdfSays) {
  // The arm coasts: its rate falls with the time constant I / c, and with friction T by T / I each second.
  const auto rate_after_a_second = [](const std::string& dynamics) {
    ImportedWorld built(robot_text(
        "<link name=\"world\"/>\n" + link_text("b") +
        "<joint name=\"j\" type=\"continuous\"><parent link=\"world\"/><child link=\"b\"/><axis xyz=\"0 0 1\"/>" +
        dynamics + "</joint>"));
    built.world.world.find_vehicle("v1")->joint("j").add_effort(2 / 0.001);  // 2 rad/s of 1 kg m^2 in a step
    built.world.run_for(1);
    return built.vehicle().joint("j").velocity();
  };
  EXPECT_NEAR(rate_after_a_second(""), 2, 1e-6);
  EXPECT_NEAR(rate_after_a_second("<dynamics damping=\"0.5\"/>"), 2 * std::exp(-0.5), 1e-3);
  EXPECT_NEAR(rate_after_a_second("<dynamics friction=\"0.7\"/>"), 2 - 0.7, 1e-5);
  EXPECT_NEAR(rate_after_a_second("<dynamics friction=\"3\"/>"), 0, 1e-6);
}

TEST(VehicleText, GivesFrictionToTheServoThatDrivesTheJoint) {
  const std::string text = tools::vehicle_text(
      imported(test::pair_text("continuous",
                               "<limit effort=\"3\" velocity=\"4\"/><dynamics damping=\"0.5\" friction=\"0.7\"/>")),
      "");
  EXPECT_THAT(text, HasSubstr("axis: [1, 0, 0], damping: 0.5}"));
  EXPECT_THAT(text, HasSubstr("max_effort: 3, friction: 0.7, safe: hold}"));
}

TEST(VehicleText, LetsAMimicJointFollowTheOther) {
  const auto joint = [](const std::string& name, const std::string& child, const std::string& more) {
    return "<joint name=\"" + name + "\" type=\"revolute\"><parent link=\"a\"/><child link=\"" + child +
           "\"/><axis xyz=\"0 0 1\"/><limit lower=\"-2\" upper=\"2\" effort=\"100\" velocity=\"2\"/>" + more +
           "</joint>\n";
  };
  // The second follows the third, which comes later; the third follows the first.
  ImportedWorld built(robot_text(link_text("a") + link_text("b") + link_text("c") + link_text("d") +
                                 joint("lead.er", "b", "") +
                                 joint("half", "c", "<mimic joint=\"minus\" multiplier=\"-0.5\"/>") +
                                 joint("minus", "d", "<mimic joint=\"lead.er\" multiplier=\"-1\" offset=\"0.2\"/>")));
  EXPECT_EQ(built.vehicle().config().devices.size(), 6u);  // one servo, group, player, two followers, joint_state
  shoal::joint_servo_command_t message{};
  message.position = 0.6;
  built.world.send("v1.lead_er.cmd", message);
  built.world.run_for(2);
  EXPECT_NEAR(built.vehicle().joint("lead_er").position(), 0.6, 1e-5);
  EXPECT_NEAR(built.vehicle().joint("minus").position(), 0.2 - 0.6, 1e-5);
  EXPECT_NEAR(built.vehicle().joint("half").position(), 0.2, 1e-5);
}

TEST(VehicleText, GivesTheVelocityButNotTheFrictionOfAMimicJointToItsFollower) {
  const auto text_of = [](const std::string& limit) {
    const tools::ImportedVehicle vehicle = imported(robot_text(
        link_text("a") + link_text("b") + link_text("c") +
        test::joint_text("continuous", "<limit effort=\"3\" velocity=\"4\"/>") +
        "<joint name=\"k\" type=\"continuous\"><parent link=\"a\"/><child link=\"c\"/><mimic joint=\"j\"/><limit " +
        limit + "/><dynamics friction=\"0.5\"/></joint>"));
    EXPECT_THAT(test::notes_of(vehicle),
                HasSubstr("joint 'k': its friction, 0.5, is not imported: it follows another joint\n"));
    return tools::vehicle_text(vehicle, "");
  };
  EXPECT_THAT(text_of("effort=\"1\" velocity=\"2\""), HasSubstr("follows: j, max_effort: 1, max_velocity: 2}"));
  EXPECT_THAT(text_of("velocity=\"2\""), HasSubstr("follows: j, max_effort: 3, max_velocity: 2}"));
}

TEST(VehicleText, PartsThatAreOnlyVisualCollideWithNothing) {
  // Two balls at the same place: if they collided, they would be pushed apart.
  const std::string ball = "<geometry><sphere radius=\"0.1\"/></geometry>";
  const test_support::ScratchFolder folder;
  std::string text = tools::vehicle_text(imported(robot_text(link_text("a", "<visual>" + ball + "</visual>"))), "");
  EXPECT_THAT(text, HasSubstr("categories: [visual, nothing]"));
  EXPECT_THAT(text, HasSubstr("category: visual, collides_with: [nothing]"));
  std::ofstream(folder.file("v.yaml")) << text;
  test::TestWorld world(
      "shoal: 1\nphysics: {step_s: 0.001, gravity_mps2: 0}\nvehicles: [{name: v1, file: " + folder.file("v.yaml") +
      "}, {name: v2, file: " + folder.file("v.yaml") + ", position_m: [0.05, 0, 0]}]");
  world.run_for(0.1);
  EXPECT_EQ(world.world.find_vehicle("v2")->body("a").X_WB().translation(), Vector3d(0.05, 0, 0));
}

TEST(VehicleText, WritesARotationOfNinetyDegreesOfPitchWithoutRollAndYaw) {
  const std::string text = tools::vehicle_text(
      imported(robot_text(link_text("a",
                                    "<collision><origin rpy=\"0 1.5707963267948966 0\"/><geometry><cylinder "
                                    "radius=\"0.1\" length=\"0.2\"/></geometry></collision>"))),
      "");
  EXPECT_THAT(text, HasSubstr("rpy_deg: [0, 90, 0]"));
}

TEST(VehicleText, DescribesTheRobotByTheFirstSentenceOfItsComment) {
  const std::string robot = robot_text(link_text("a"));
  EXPECT_THAT(tools::vehicle_text(imported("<!-- A robot: small. More. -->\n" + robot), "s.json"),
              testing::StartsWith("# yaml-language-server: $schema=s.json\n# A robot: small. More.\n"));
  EXPECT_THAT(tools::vehicle_text(imported("<!-- A robot: small. More. -->\n" + robot), ""),
              HasSubstr("\ndescription: \"A robot: small.\"\n"));
  EXPECT_THAT(tools::vehicle_text(imported(robot), ""), HasSubstr("\ndescription: Imported from r.urdf.\n"));
}

TEST(VehicleText, IsUtf8WhateverTheEncodingOfTheComment) {
  const std::string robot = robot_text(link_text("a"));
  EXPECT_THAT(
      tools::vehicle_text(imported("<!-- Caf\xc3\xa9 ${x}. More. -->\n" + robot), ""),
      testing::AllOf(HasSubstr("# Caf\xc3\xa9 ${x}. More.\n"), HasSubstr("description: \"Caf\xc3\xa9 _{x}.\"\n")));
  EXPECT_THAT(tools::vehicle_text(imported("<!-- Caf\xe9 -->\n" + robot), ""), HasSubstr("# Caf?\n"));
}

TEST(VehicleText, ShippedBittleIsTheImportOfItsUrdf) {
  const std::string path = test_support::source_path("tests/tools/shoal/urdf/bittle.urdf");
  const tools::ImportedVehicle vehicle = tools::vehicle_of(tools::read_urdf_file(path), path);
  EXPECT_EQ(tools::vehicle_text(vehicle, "../docs/reference/schema/vehicle.schema.json"),
            content_of(test_support::source_path("vehicles/bittle.yaml")));
  double mass_kg = 0;
  for (const tools::ImportedBody& body : vehicle.bodies) mass_kg += body.mass_kg;
  EXPECT_NEAR(mass_kg, 0.292, 1e-12);  // of the maker's model: torso 0.2, upper legs 0.006, lower legs 0.017
}

TEST(VehicleText, BittleStandsAsHighAsItsLegsAreLong) {
  test::LoadedTestWorld test(test_support::source_path("worlds/bittle_bench.yaml"));
  test.run_for(2);
  // 46 mm and 51.75 mm, both at 30 degrees from the vertical, and the radius of the foot.  0.1 mm: sinking into the
  // bench by up to contact_surface_layer_m = 0.5 mm is the larger part.
  const double height_m = (0.046 + 0.05175) * std::cos(std::numbers::pi / 6) + 0.005;
  EXPECT_NEAR(test.world.find_vehicle("bittle1")->X_WV().translation().z(), height_m, 6e-4);
}

TEST(FlowLines, NumbersAreAsShortAsTheyCanBe) {
  EXPECT_EQ(tools::short_number(0.1), "0.1");
  EXPECT_EQ(tools::short_number(2), "2");
  EXPECT_EQ(tools::short_number(1.0 / 3), "0.3333333333");
  EXPECT_EQ(tools::short_number(1e-13), "0");
  EXPECT_EQ(tools::short_number(-1e-13), "0");
  EXPECT_EQ(tools::short_list({1, -0.5, 1e-15}), "[1, -0.5, 0]");
}

TEST(FlowLines, AMapStandsOnOneLineIfItFits) {
  tools::FlowMap map;
  map.add("name", "left");
  map.add("mass_kg", 1.5);
  map.add("axis", sim::Vector3d(0, 1, 0));
  map.add_unless_zero("position_m", sim::Vector3d::Zero());
  EXPECT_EQ(map.lines("  - "), "  - {name: left, mass_kg: 1.5, axis: [0, 1, 0]}\n");
}

TEST(FlowLines, ALongMapIsBrokenBetweenItsEntries) {
  tools::FlowMap map;
  for (int i = 0; i < 20; ++i) map.add("entry_number_" + std::to_string(i), 1.25);
  const std::string text = map.lines("  - ");
  EXPECT_GT(text.size(), 120u);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    EXPECT_LE(end - begin, 120u);
    begin = end + 1;
  }
}

TEST(FlowLines, TextsHaveQuotesWhereTheyNeedThem) {
  EXPECT_EQ(tools::yaml_scalar("left wheel"), "left wheel");
  for (const char* text : {"yes: no", "{a}", "- a", ""}) EXPECT_NE(tools::yaml_scalar(text), text) << text;
}

}  // namespace
