// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/sdf/sdf_plugins.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/tools/shoal/sdf/sdf_texts.hpp"

namespace {

using namespace test;
using testing::HasSubstr;

/// A hull and what a joint carries at (-1, 0, 0); axis: that of the joint.
std::string driven(const std::string& plugin, const std::string& axis, const std::string& limit = "") {
  return sdf_text(sdf_link("a") + sdf_link("b", "<pose>-1 0 0 0 0 0</pose>") +
                  sdf_joint("revolute", "<axis><xyz>" + axis + "</xyz>" + limit + "</axis>") + plugin);
}

TEST(SdfPlugins, MountAThrusterOnTheHull) {
  const tools::RobotImport import =
      imported_sdf(driven(sdf_plugin("Thruster",
                                     "<joint_name>j</joint_name><propeller_diameter>0.1</propeller_diameter>"
                                     "<max_thrust_cmd>40</max_thrust_cmd><min_thrust_cmd>-30</min_thrust_cmd>"),
                          "0 0 -1"));
  ASSERT_EQ(import.vehicle.bodies.size(), 1u);
  EXPECT_DOUBLE_EQ(import.vehicle.bodies[0].mass_kg, 2);
  const tools::ImportedDevice& thruster = device_of(import, "j");
  EXPECT_TRUE(thruster.X_BS.translation().isApprox(sim::Vector3d(-1, 0, 0)));
  EXPECT_TRUE(thruster.X_BS.linear().col(0).isApprox(-sim::Vector3d::UnitZ(), 1e-12));
  EXPECT_EQ(key_of(thruster.keys, "command"), "thrust_N");
  EXPECT_EQ(key_of(thruster.keys, "max"), "40");
  EXPECT_EQ(key_of(thruster.keys, "min"), "-30");
  EXPECT_THAT(notes_of(import.vehicle),
              HasSubstr("m.sdf:4: joint 'j' is fixed: a `thruster` does not turn its propeller\n"));
}

TEST(SdfPlugins, TurnASpeedIntoThrust) {
  // 1000 kg/m^3 (0.1 m)^4 0.02 = 0.002 N per (rad/s)^2; astern where the coefficient is negative.
  const auto thruster = [](const std::string& more) {
    return device_of(imported_sdf(driven(sdf_plugin("Thruster",
                                                    "<joint_name>j</joint_name><use_angvel_cmd>true</use_angvel_cmd>"
                                                    "<propeller_diameter>0.1</propeller_diameter>" +
                                                        more),
                                         "1 0 0")),
                     "j");
  };
  const tools::ImportedDevice ahead = thruster("<thrust_coefficient>0.02</thrust_coefficient><deadband>0.2</deadband>");
  EXPECT_EQ(key_of(ahead.keys, "command"), "radps");
  EXPECT_EQ(key_of(ahead.keys, "ahead"), "0.002");
  EXPECT_EQ(key_of(ahead.keys, "dead_band"), "10");  // 0.002 10^2 is 0.2 N
  EXPECT_TRUE(ahead.X_BS.linear().col(0).isApprox(sim::Vector3d::UnitX()));
  EXPECT_TRUE(thruster("<thrust_coefficient>-0.02</thrust_coefficient>")
                  .X_BS.linear()
                  .col(0)
                  .isApprox(-sim::Vector3d::UnitX(), 1e-12));
  // Without a coefficient: rho D^4 alpha_1, and a loss of rho D^3 |alpha_2| (1 - wake) per inflow.
  const tools::ImportedDevice open =
      thruster("<alpha_1>0.05</alpha_1><alpha_2>-0.1</alpha_2><wake_fraction>0.2</wake_fraction>");
  EXPECT_EQ(key_of(open.keys, "ahead"), "0.005");
  EXPECT_EQ(key_of(open.keys, "inflow_loss"), "0.08");
}

TEST(SdfPlugins, MakeAFinOfLiftAndDrag) {
  // A rudder behind: forward and the axis up, so that positive angles of the joint turn the leading edge to the left.
  const std::string rudder =
      sdf_plugin("LiftDrag",
                 "<link_name>b</link_name><air_density>1000</air_density><area>0.02</area><cla>4</cla><cda>0.1</cda>"
                 "<alpha_stall>0.2</alpha_stall><forward>1 0 0</forward><upward>0 1 0</upward><cp>0.1 0 0</cp>");
  const tools::RobotImport import =
      imported_sdf(driven(rudder, "0 0 1", "<limit><lower>-0.3</lower><upper>0.2</upper></limit>"));
  ASSERT_EQ(import.vehicle.bodies.size(), 1u);
  const tools::ImportedDevice& fin = device_of(import, "j");
  EXPECT_EQ(fin.type, "fin");
  EXPECT_TRUE(fin.X_BS.linear().isApprox(sim::Matrix3d::Identity()));
  EXPECT_TRUE(fin.X_BS.translation().isApprox(sim::Vector3d(-0.9, 0, 0)));
  EXPECT_EQ(key_of(fin.keys, "lift_slope"), "4");
  EXPECT_NEAR(std::stod(key_of(fin.keys, "stall_deg")), sim::radians_to_degrees(0.2), 1e-6);
  EXPECT_NEAR(std::stod(key_of(fin.keys, "limit_deg")), sim::radians_to_degrees(0.3), 1e-6);
  // At the stall the drag is 0.1 0.2 in both models: (4 0.2)^2 / (pi AR) = 0.02.
  EXPECT_NEAR(std::stod(key_of(fin.keys, "aspect_ratio")), 0.64 / (M_PI * 0.02), 1e-6);
}

TEST(SdfPlugins, LeaveOutWingsInAir) {
  const tools::RobotImport import = imported_sdf(driven(sdf_plugin("LiftDrag", "<link_name>b</link_name>"), "0 0 1"));
  EXPECT_EQ(import.vehicle.bodies.size(), 2u);
  EXPECT_THAT(notes_of(import.vehicle),
              HasSubstr("m.sdf:5: plugin 'gz::sim::systems::LiftDrag' is not imported: a `fin` works "
                        "in water, and its <air_density> is that of a gas\n"));
}

TEST(SdfPlugins, DriveWheelsWhoseAxesPointToTheRight) {
  const auto wheel = [](const std::string& name, const std::string& y) {
    return sdf_link(name, "<pose>0 " + y + " 0 0 0 0</pose>") + "<joint name=\"j" + name +
           "\" type=\"revolute\"><parent>a</parent><child>" + name +
           "</child><axis><xyz>0 -1 0</xyz><limit><effort>3</effort></limit></axis></joint>\n";
  };
  const tools::RobotImport import =
      imported_sdf(sdf_text(sdf_link("a") + wheel("l", "0.2") + wheel("r", "-0.2") +
                            sdf_plugin("DiffDrive",
                                       "<left_joint>jl</left_joint><right_joint>jr</right_joint><wheel_separation>0.4"
                                       "</wheel_separation><wheel_radius>0.1</wheel_radius>"
                                       "<max_linear_velocity>0.5</max_linear_velocity>")));
  const tools::ImportedDevice& drive = device_of(import, "drive");
  EXPECT_EQ(drive.type, "differential_drive");
  EXPECT_EQ(key_of(drive.keys, "left_joint"), "jl");
  EXPECT_EQ(key_of(drive.keys, "track_m"), "0.4");
  EXPECT_EQ(key_of(drive.keys, "max_speed_mps"), "0.5");
  EXPECT_EQ(key_of(drive.keys, "max_torque_Nm"), "3");
  EXPECT_TRUE(import.vehicle.joints.at(0).axis_V.isApprox(sim::Vector3d::UnitY()));
  EXPECT_EQ(notes_of(import.vehicle), "");
}

TEST(SdfPlugins, CountTheVolumeOfABuoyancyEngineFromTheNeutralOne) {
  const tools::RobotImport import =
      imported_sdf(sdf_text(sdf_link("a") + sdf_plugin("BuoyancyEngine",
                                                       "<link_name>a</link_name><min_volume>0.00008</min_volume>"
                                                       "<neutral_volume>0.0005</neutral_volume><default_volume>0.0005"
                                                       "</default_volume><max_volume>0.000955</max_volume>")));
  const tools::ImportedDevice& engine = device_of(import, "buoyancy_engine");
  EXPECT_EQ(key_of(engine.keys, "max_m3"), "0.000455");
  EXPECT_EQ(key_of(engine.keys, "min_m3"), "-0.00042");
  EXPECT_EQ(key_of(engine.keys, "initial_m3"), "0");
}

TEST(SdfPlugins, NameWhatIsWrong) {
  const auto notes = [](const std::string& plugin) {
    return notes_of(imported_sdf(sdf_text(sdf_link("a") + plugin)).vehicle);
  };
  EXPECT_EQ(notes(sdf_plugin("Thruster", "<joint_name>none</joint_name>")),
            "m.sdf:3: plugin 'gz::sim::systems::Thruster' is not imported: there is no such <joint_name>\n");
  EXPECT_EQ(
      notes(sdf_plugin("DiffDrive", "")),
      "m.sdf:3: plugin 'gz::sim::systems::DiffDrive' is not imported: it needs a <left_joint> and a <right_joint>\n");
  EXPECT_EQ(notes(sdf_plugin("Imu", "")), "");
}

}  // namespace
