// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/sdf/sdf_import.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "shoal/actuator_command_t.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/tools/shoal/sdf/sdf_texts.hpp"

// Numbers of public models.  The texts are our own; each test names the model from which its figures are.

namespace {

using namespace test;
using testing::HasSubstr;

std::string fixed_link(const std::string& name, double mass_kg, const std::string& pose = "0 0 0 0 0 0",
                       const std::string& more = "") {
  return sdf_link(name, "<pose>" + pose + "</pose>" + more, mass_kg) + "<joint name=\"" + name +
         "_joint\" type=\"fixed\"><parent>base_link</parent><child>" + name + "</child></joint>\n";
}

/// A link that a thruster drives about its axis.
std::string propeller(const std::string& name, const std::string& pose, const std::string& axis, double mass_kg,
                      const std::string& keys) {
  return "<link name=\"" + name + "\"><pose>" + pose + "</pose>" + sdf_mass(mass_kg, "0.001 0.001 0.001") +
         "</link>\n<joint name=\"" + name + "_joint\" type=\"revolute\"><parent>base_link</parent><child>" + name +
         "</child><axis><xyz>" + axis + "</xyz></axis></joint>\n" +
         sdf_plugin("Thruster", "<joint_name>" + name + "_joint</joint_name>" + keys);
}

std::string hydrodynamics(const std::string& keys, const std::string& name = "Hydrodynamics") {
  return sdf_plugin(name, "<link_name>base_link</link_name>" + keys);
}

/// The vehicle `v`, deep in water of 1000 kg/m^3.
class InWater : public TestWorld {
 public:
  explicit InWater(const tools::RobotImport& import) : TestWorld(world_text(import.text)) {}

  void command(const std::string& device, double value) {
    shoal::actuator_command_t message{};
    message.value = value;
    send("v." + device + ".cmd", message);
  }
  /// Velocity of the first body in its own axes.
  sim::Vector3d v_WB_B() const {
    const sim::Body& body = world.vehicles()[0]->base();
    return body.X_WB().linear().transpose() * body.v_WB_W();
  }

 private:
  static std::string world_text(const std::string& vehicle) {
    std::string text =
        "shoal: 1\nphysics: {step_s: 0.005}\nmedium: {water: {density_kgpm3: 1000, surface_m: 100}}\nvehicles:\n"
        "  - name: v\n    model:\n      ";
    for (const char c : vehicle) text += c == '\n' ? std::string("\n      ") : std::string(1, c);
    return text + "\n";
  }
};

TEST(SdfImport, OfABlueRov2ReachesTheSpeedAtWhichDragIsThrust) {
  // github.com/clydemcqueen/bluerov2_gz, models/bluerov2: a hull of 10 kg and six propellers of 2 g, a box that
  // displaces 0.457 0.338 0.065 m^3, and a drag of 33.732 N/(m/s)^2 ahead.
  std::string text =
      "<link name=\"base_link\">" + sdf_mass(10, "0.099 0.178 0.269", "0 0 0.011 0 0 0") +
      "<collision name=\"c\"><pose>0 0 0.06 0 0 0</pose><geometry><box><size>0.457 0.338 0.065</size></box></geometry>"
      "</collision></link>\n" +
      hydrodynamics(
          "<xUabsU>-33.732</xUabsU><yVabsV>-54.16</yVabsV><zWabsW>-73.225</zWabsW><kPabsP>-3.992</kPabsP>"
          "<mQabsQ>-3.992</mQabsQ><nRabsR>-3.992</nRabsR>");
  const std::vector<std::string> poses = {"0.14 -0.092 0 -1.571 1.571 -0.785",
                                          "0.14 0.092 0 -1.571 1.571 -2.356",
                                          "-0.15 -0.092 0 -1.571 1.571 0.785",
                                          "-0.15 0.092 0 -1.571 1.571 2.356",
                                          "0 -0.109 0.077 0 0 0",
                                          "0 0.109 0.077 0 0 0"};
  for (std::size_t i = 0; i < poses.size(); ++i)
    text += propeller("thruster" + std::to_string(i + 1), poses[i], "0 0 -1", 0.002,
                      "<propeller_diameter>0.1</propeller_diameter><thrust_coefficient>0.02</thrust_coefficient>");
  const tools::RobotImport import = imported_sdf(sdf_text(text, "1.6"));
  ASSERT_EQ(import.vehicle.bodies.size(), 1u);
  const tools::ImportedBody& hull = import.vehicle.bodies[0];
  EXPECT_NEAR(hull.mass_kg, 10.012, 1e-12);
  EXPECT_NEAR(std::stod(key_of(hull.water, "volume_m3")), 0.01004029, 1e-9);
  // Pitched and rolled by 90 degrees and turned by a, the axis -z of a propeller is (sin a, -cos a).
  const sim::Vector3d first = device_of(import, "thruster1_joint").X_BS.linear().col(0);
  EXPECT_TRUE(first.isApprox(sim::Vector3d(-M_SQRT1_2, -M_SQRT1_2, 0), 1e-3));
  // Those in front pull, those behind push, 10 N each at 45 degrees: sqrt(40 cos(45) / 33.732) = 0.9157 m/s.
  InWater world(import);
  for (const int i : {1, 2}) world.command("thruster" + std::to_string(i) + "_joint", -10);
  for (const int i : {3, 4}) world.command("thruster" + std::to_string(i) + "_joint", 10);
  world.run_for(20);
  EXPECT_NEAR(world.v_WB_B().x(), 0.9157, 0.005);
}

TEST(SdfImport, OfALongRangeAuvRunsAtAMeterPerSecondWith300Rpm) {
  // github.com/osrf/lrauv, tethys and tethys_equipped: thrust of 0.004312328 1025 0.2^4 N/(rad/s)^2, drag of
  // 6.2282 N/(m/s)^2; the vehicle faces -x, and the joint is turned about y.  300 rpm give 6.980 N and 1.0586 m/s.  The
  // battery and what else is in the hull are one mass here, 2 cm below the middle, so far ahead that it is level.
  const double weight_kg = 147.8671;
  const tools::RobotImport import = imported_sdf(sdf_text(
      "<link name=\"base_link\">" + sdf_mass(weight_kg - 0.09, "3 41.980233 41.980233", "-0.000872 0 -0.02 0 0 0") +
      "<collision name=\"c\"><geometry><box><size>2 0.3 0.2464451667</size></box></geometry></collision></link>\n" +
      hydrodynamics("<enable_coriolis>false</enable_coriolis><xDotU>-4.876161</xDotU><yDotV>-126.324739</"
                    "yDotV><zDotW>-126.324739</zDotW><mDotQ>-33.46</mDotQ>"
                    "<nDotR>-33.46</nDotR><xUabsU>-6.2282</xUabsU><yVabsV>-601.27</yVabsV><zWabsW>-601.27</zWabsW>"
                    "<kPabsP>-0.1916</kPabsP><mQabsQ>-632.698957</mQabsQ><nRabsR>-632.698957</nRabsR>") +
      "<link name=\"propeller\"><pose>1.43162 0 0 0 0 0</pose>" + sdf_mass(0.09, "0.001 0.001 0.001") +
      "</link>\n<joint name=\"propeller_joint\" type=\"revolute\"><pose degrees=\"true\">0 0 0 0 180 0</pose>"
      "<parent>base_link</parent><child>propeller</child><axis><xyz>1 0 0</xyz></axis></joint>\n" +
      sdf_plugin("Thruster",
                 "<joint_name>propeller_joint</joint_name><thrust_coefficient>0.004312328425753156"
                 "</thrust_coefficient><fluid_density>1025</fluid_density><propeller_diameter>0.2"
                 "</propeller_diameter><use_angvel_cmd>true</use_angvel_cmd>")));
  EXPECT_NEAR(import.vehicle.bodies.at(0).mass_kg, weight_kg, 1e-9);
  InWater world(import);
  world.command("propeller_joint", 300 * 2 * M_PI / 60);
  world.run_for(200);
  EXPECT_NEAR(world.v_WB_B().x(), -1.0586, 0.001);
}

TEST(SdfImport, OfALongRangeAuvHasItsRudderAndElevator) {
  // The same model: area 0.0244 m^2, slope 4.13 per rad, stall at 0.17 rad, deflections of 15 degrees.
  const auto fin = [](const std::string& name, const std::string& joint_pose, const std::string& axis,
                      const std::string& upward) {
    return "<link name=\"" + name + "\"><pose>1.05 0 0 0 0 0</pose>" + sdf_mass(0.2) + "</link>\n<joint name=\"" +
           name + "_joint\" type=\"revolute\"><pose degrees=\"true\">" + joint_pose +
           "</pose><parent>base_link</parent><child>" + name + "</child><axis><xyz>" + axis +
           "</xyz><limit><lower>-0.261799</lower><upper>0.261799</upper></limit></axis></joint>\n" +
           sdf_plugin("LiftDrag",
                      "<air_density>1025</air_density><cla>4.13</cla><cda>0.2</cda><alpha_stall>0.17</alpha_stall>"
                      "<area>0.0244</area><forward>-1 0 0</forward><upward>" +
                          upward + "</upward><link_name>" + name + "</link_name><cp>0 0 0</cp>");
  };
  const tools::RobotImport import =
      imported_sdf(sdf_text(sdf_link("base_link") + fin("vertical_fins", "0 0 0 180 0 0", "0 0 1", "0 1 0") +
                            fin("horizontal_fins", "0 0 0 0 0 0", "0 1 0", "0 0 1")));
  const tools::ImportedDevice& rudder = device_of(import, "vertical_fins_joint");
  EXPECT_TRUE(rudder.X_BS.linear().col(0).isApprox(-sim::Vector3d::UnitX(), 1e-12));
  EXPECT_TRUE(rudder.X_BS.linear().col(2).isApprox(-sim::Vector3d::UnitZ(), 1e-12));  // z of the turned joint
  const tools::ImportedDevice& elevator = device_of(import, "horizontal_fins_joint");
  EXPECT_TRUE(elevator.X_BS.linear().col(2).isApprox(sim::Vector3d::UnitY(), 1e-12));
  for (const tools::ImportedDevice* each : {&rudder, &elevator}) {
    EXPECT_EQ(key_of(each->keys, "area_m2"), "0.0244");
    EXPECT_EQ(key_of(each->keys, "lift_slope"), "4.13");
    EXPECT_NEAR(std::stod(key_of(each->keys, "limit_deg")), 15, 1e-4);
    EXPECT_NEAR(std::stod(key_of(each->keys, "stall_deg")), 9.740, 1e-3);
  }
}

TEST(SdfImport, OfAWamVHasThePositiveDampingOfVrx) {
  // github.com/osrf/vrx, wamv_base and wamv_gazebo_dynamics_plugin: 180 kg, drag of 100 u + 150 u |u|.
  const tools::RobotImport import = imported_sdf(sdf_text(
      "<link name=\"base_link\">" + sdf_mass(180, "120 393 446") + "</link>\n" +
      hydrodynamics("<xDotU>0</xDotU><yDotV>0</yDotV><nDotR>0</nDotR><xU>100</xU><xUU>150</xUU><yV>100</yV>"
                    "<yVV>100</yVV><zW>500</zW><kP>300</kP><kPP>600</kPP><mQ>900</mQ><mQQ>900</mQQ><nR>800</nR>"
                    "<nRR>800</nRR>",
                    "SimpleHydrodynamics") +
      propeller("left", "-2.65 1.03 -0.5 0 0 0", "1 0 0", 0.5, "") +
      propeller("right", "-2.65 -1.03 -0.5 0 0 0", "1 0 0", 0.5, "")));
  const tools::ImportedBody& hull = import.vehicle.bodies.at(0);
  EXPECT_DOUBLE_EQ(hull.mass_kg, 181);
  // The mean of (0, 0, 0) and of 1 kg at (-2.65, 0, -0.5).
  EXPECT_TRUE(hull.center_of_mass_m.isApprox(sim::Vector3d(-2.65, 0, -0.5) / 181, 1e-9));
  EXPECT_EQ(key_of(hull.water, "linear_damping"), "[100, 100, 500, 300, 900, 800]");
  EXPECT_EQ(key_of(hull.water, "quadratic_damping"), "[150, 100, 0, 600, 900, 800]");
  EXPECT_EQ(key_of(hull.water, "added_mass"), "[0, 0, 0.1, 0.1, 0.1, 0]");  // defaults of the plugin
  EXPECT_EQ(key_of(hull.water, "quirks"), "{added_mass_coriolis: none}");
  // 2 250 N: (-100 + sqrt(100^2 + 4 150 500)) / 300 = 1.5226 m/s.
  InWater world(import);
  for (const std::string side : {"left", "right"}) world.command(side + "_joint", 250);
  world.run_for(1);
  EXPECT_GT(world.v_WB_B().x(), 0.5);
}

TEST(SdfImport, OfARexRovHasTheMatrixOfUuvSimulator) {
  // github.com/uuvsimulator/uuv_simulator, rexrov.gazebo.xacro (Berg 2012): forward-right-down.
  const tools::RobotImport import = imported_sdf(sdf_text(
      "<link name=\"base_link\">" + sdf_mass(1862.87, "525.39 794.20 691.23") + "</link>\n" +
      "<plugin name=\"uuv_plugin\" filename=\"libuuv_underwater_object_ros_plugin.so\"><link name=\"base_link\">"
      "<volume>1.83826</volume><center_of_buoyancy>0 0 0.3</center_of_buoyancy><box><height>1.6</height></box>"
      "<hydrodynamic_model><type>fossen</type><added_mass>\n"
      "779.79 -6.8773 -103.32 8.5426 -165.54 -7.8033\n-6.8773 1222 51.29 409.44 -5.8488 62.726\n"
      "-103.32 51.29 3659.9 6.1112 -386.42 10.774\n8.5426 409.44 6.1112 534.9 -10.027 21.019\n"
      "-165.54 -5.8488 -386.42 -10.027 842.69 -1.1162\n-7.8033 62.726 10.775 21.019 -1.1162 224.32</added_mass>"
      "<linear_damping>-74.82 -69.48 -728.4 -268.8 -309.77 -105</linear_damping>"
      "<quadratic_damping>-748.22 -992.53 -1821.01 -672 -774.44 -523.27</quadratic_damping>"
      "</hydrodynamic_model></link></plugin>\n"));
  const tools::YamlEntries& water = import.vehicle.bodies.at(0).water;
  // In forward-left-up the couplings of surge and roll with the others change their signs.
  EXPECT_THAT(key_of(water, "added_mass"),
              HasSubstr("[779.79, 6.8773, 103.32, 8.5426, 165.54, 7.8033, 6.8773, 1222, 51.29, "
                        "-409.44, -5.8488, 62.726"));
  EXPECT_THAT(notes_of(import.vehicle), HasSubstr("the added mass is not symmetric"));  // 10.774 and 10.775
  EXPECT_EQ(key_of(water, "quadratic_damping"), "[748.22, 992.53, 1821.01, 672, 774.44, 523.27]");
  EXPECT_EQ(error_of_world("shoal: 1\nmedium: {water: {}}\nvehicles: [{name: v, model: {shoal: 1, bodies: [{name: b, "
                           "hydrodynamics: {mass_kg: 1862.87, inertia_kgm2: [525, 794, 691], added_mass: " +
                           key_of(water, "added_mass") + "}}]}}]\n"),
            "");
}

TEST(SdfImport, OfATurtleBot3HasMassesWheelsAndLidar) {
  // github.com/ROBOTIS-GIT/turtlebot3_simulations, turtlebot3_burger.
  const auto wheel = [](const std::string& side, const std::string& y) {
    return "<link name=\"wheel_" + side + "\">" +
           sdf_mass(0.1, "5.445e-05 5.445e-05 1.089e-04", "0 " + y + " 0.023 -1.57 0 0") +
           "</link>\n<joint name=\"wheel_" + side +
           "_joint\" type=\"revolute\"><parent>base_link</parent><child>wheel_" + side + "</child><pose>0 " + y +
           " 0.023 -1.57 0 0</pose><axis><xyz>0 0 1</xyz><limit><effort>20</effort></limit>"
           "</axis></joint>\n";
  };
  const tools::RobotImport import = imported_sdf(sdf_text(
      "<link name=\"base_link\">" + sdf_mass(0.82573504, "0.019527 0.019527 0.019527", "-0.064 0 0.07 0 0 0") +
          "</link>\n" +
          fixed_link(
              "base_scan", 0.114, "0 0 0 0 0 0",
              "<sensor name=\"lds\" type=\"gpu_lidar\"><pose>-0.032 0 0.171 0 0 0</pose><update_rate>5</update_rate>"
              "<lidar><scan><horizontal><samples>360</samples><min_angle>0</min_angle><max_angle>6.28</max_angle>"
              "</horizontal></scan><range><min>0.12</min><max>3.5</max></range></lidar></sensor>") +
          wheel("left", "0.08") + wheel("right", "-0.08") +
          sdf_plugin("DiffDrive",
                     "<left_joint>wheel_left_joint</left_joint><right_joint>wheel_right_joint</right_joint>"
                     "<wheel_separation>0.160</wheel_separation><wheel_radius>0.033</wheel_radius>"),
      "1.8"));
  double mass_kg = 0;
  for (const tools::ImportedBody& body : import.vehicle.bodies) mass_kg += body.mass_kg;
  EXPECT_NEAR(mass_kg, 1.13973504, 1e-9);
  ASSERT_EQ(import.vehicle.joints.size(), 2u);
  for (const tools::ImportedJoint& joint : import.vehicle.joints)
    EXPECT_TRUE(joint.axis_V.isApprox(sim::Vector3d::UnitY(), 1e-3));  // -1.57 rad about x
  EXPECT_EQ(key_of(device_of(import, "drive").keys, "track_m"), "0.16");
  EXPECT_EQ(key_of(device_of(import, "lds").keys, "beams"), "360");
  EXPECT_NEAR(sim::yaw_of(device_of(import, "lds").X_BS.linear()), 3.14, 1e-9);
}

TEST(SdfImport, OfAPioneerHasAxesInTheFrameOfTheModel) {
  // github.com/osrf/gazebo_models, pioneer2dx: wheels whose frames are turned, 5.67 and 1.5 kg.
  const auto wheel = [](const std::string& side, const std::string& y, const std::string& z) {
    return sdf_link(side + "_wheel", "<pose>0.1 " + y + " 0.11 0 1.5707 1.5707</pose>", 1.5) + "<joint name=\"" + side +
           "_wheel_hinge\" type=\"revolute\"><pose>0 0 " + z + " 0 0 0</pose><child>" + side +
           "_wheel</child><parent>chassis</parent><axis><xyz>0 1 0</xyz><use_parent_model_frame>true"
           "</use_parent_model_frame></axis></joint>\n";
  };
  const tools::RobotImport import = imported_sdf(sdf_text(
      sdf_link("chassis", "<pose>0 0 0.16 0 0 0</pose>", 5.67) + wheel("left", ".17", "-0.03") +
          wheel("right", "-.17", "0.03") +
          "<plugin filename=\"libDiffDrivePlugin.so\" name=\"diff_drive\"><left_joint>left_wheel_hinge</left_joint>"
          "<right_joint>right_wheel_hinge</right_joint><torque>5</torque></plugin>",
      "1.5"));
  const tools::ImportedJoint& left = import.vehicle.joints.at(0);
  EXPECT_TRUE(left.axis_V.isApprox(sim::Vector3d::UnitY(), 1e-12));
  // z of a wheel is y of the model: the hinge is 3 cm further in.
  EXPECT_TRUE(left.anchor_V.value().isApprox(sim::Vector3d(0.1, 0.14, 0.11), 1e-3));
  EXPECT_EQ(key_of(device_of(import, "drive").keys, "max_torque_Nm"), "5");
  EXPECT_DOUBLE_EQ(import.vehicle.bodies.at(0).X_VB.translation().z(), 0.16);
}

TEST(SdfImport, OfAnX500HasTheMassOfItsRotors) {
  // github.com/PX4/PX4-gazebo-models, x500_base: 2 kg and four rotors of 0.0160769 kg at (+-0.174, +-0.174, 0.06).
  std::string text = "<pose>0 0 .24 0 0 0</pose><link name=\"base_link\">" +
                     sdf_mass(2, "0.02166666666666667 0.02166666666666667 0.04") +
                     "<sensor name=\"baro\" type=\"air_pressure\"><update_rate>50</update_rate><air_pressure><pressure>"
                     "<noise type=\"gaussian\"><stddev>3</stddev></noise></pressure></air_pressure></sensor></link>\n";
  int number = 0;
  for (const std::string place : {"0.174 -0.174", "-0.174 0.174", "0.174 0.174", "-0.174 -0.174"}) {
    const std::string rotor = "rotor_" + std::to_string(number++);
    text += sdf_link(rotor, "<pose>" + place + " 0.06 0 0 0</pose>", 0.016076923) + "<joint name=\"" + rotor +
            "_joint\" type=\"revolute\"><parent>base_link</parent><child>" + rotor +
            "</child><axis><xyz>0 0 1</xyz><limit><lower>-1e+16</lower><upper>1e+16</upper></limit></axis></joint>\n" +
            sdf_plugin("MulticopterMotorModel", "");
  }
  const tools::RobotImport import = imported_sdf(sdf_text(text));
  double mass_kg = 0;
  sim::Vector3d moment = sim::Vector3d::Zero();
  for (const tools::ImportedBody& body : import.vehicle.bodies) {
    mass_kg += body.mass_kg;
    moment += body.mass_kg * (body.X_VB * body.center_of_mass_m);
  }
  EXPECT_NEAR(mass_kg, 2.064308, 1e-5);
  EXPECT_TRUE((moment / mass_kg).isApprox(sim::Vector3d(0, 0, 0.06 * 0.064308 / 2.064308), 1e-3));
  EXPECT_EQ(key_of(device_of(import, "baro").keys, "pressure_noise"), "{gaussian_std: 3}");
  EXPECT_THAT(notes_of(import.vehicle), HasSubstr("its <pose> is not imported: a world places its vehicles"));
  EXPECT_THAT(notes_of(import.vehicle), HasSubstr("is not imported: Shoal has no rotors in air"));
}

TEST(SdfImport, OfABlueRov2HeavyHasLinearAndQuadraticDrag) {
  // github.com/PX4/PX4-gazebo-models, uuv_bluerov2_heavy: 13 kg, 0.0135 m^3, 13.7 u + 14.1 u |u|.  With 20 N:
  // (-13.7 + sqrt(13.7^2 + 4 14.1 20)) / 28.2 = 0.8004 m/s.
  const tools::RobotImport import = imported_sdf(sdf_text(
      "<link name=\"base_link\">" + sdf_mass(13, "0.250 0.221 0.356") +
      "<collision name=\"c\"><pose>0 0 0.02 0 0 0</pose><geometry><box><size>0.50 0.25 0.108</size></box></geometry>"
      "</collision></link>\n" +
      hydrodynamics("<xU>-13.7</xU><yV>-1</yV><zW>-23</zW><kP>-0.5</kP><mQ>-0.8</mQ><nR>-0.1</nR>"
                    "<xUabsU>-14.1</xUabsU><yVabsV>-21.7</yVabsV><zWabsW>-19</zWabsW><kPabsP>-0.119</kPabsP>"
                    "<mQabsQ>-0.047</mQabsQ><nRabsR>-0.15</nRabsR><xDotU>-1.272</xDotU><yDotV>-1.424</yDotV>"
                    "<zDotW>-3.736</zDotW><kDotP>-0.0378</kDotP><mDotQ>-0.027</mDotQ><nDotR>-0.0444</nDotR>") +
      propeller("middle", "0 0 0 0 0 0", "1 0 0", 1e-6, "")));
  EXPECT_EQ(key_of(import.vehicle.bodies.at(0).water, "volume_m3"), "0.0135");
  EXPECT_EQ(key_of(import.vehicle.bodies.at(0).water, "added_mass"), "[1.272, 1.424, 3.736, 0.0378, 0.027, 0.0444]");
  // Its half liter too much buoyancy lifts it: heave is not at rest, and the Munk moment turns it slowly.
  InWater world(import);
  world.command("middle_joint", 20);
  world.run_for(8);
  EXPECT_NEAR(world.v_WB_B().x(), 0.8004, 0.1);
}

TEST(SdfImport, OfAGliderKeepsItsCrossTerms) {
  // github.com/IOES-Lab/dave, glider_slocum: 69.25 kg, an IMU of 0.015 and a propeller of 0.5 kg.
  const tools::RobotImport import = imported_sdf(
      sdf_text("<link name=\"base_link\">" + sdf_mass(69.25, "13.193856 0.418962 13.193856", "0 0 -0.06 0 0 0") +
                   sdf_box("0.22 1.5 0.22") + "</link>\n" + fixed_link("imu_link", 0.015) +
                   propeller("propeller", "0 0 0 0 0 0", "0 1 0", 0.5, "") +
                   hydrodynamics("<xU>-8</xU><yV>-162</yV><zW>-108</zW><kP>-13</kP><mQ>-20</mQ><nR>-32</nR><yR>150</yR>"
                                 "<zQ>-100</zQ><mW>37</mW><nV>-34</nV>"),
               "1.7"));
  const tools::ImportedBody& hull = import.vehicle.bodies.at(0);
  EXPECT_NEAR(hull.mass_kg, 69.765, 1e-9);
  EXPECT_NEAR(hull.center_of_mass_m.z(), -0.06 * 69.25 / 69.765, 1e-9);
  EXPECT_EQ(key_of(hull.water, "volume_m3"), "0.0726");
  EXPECT_EQ(key_of(hull.water, "derivatives"), "{M_w: 37, N_v: -34, Y_r: 150, Z_q: -100}");
}

TEST(SdfImport, OfADvlHasItsBeamsAndAltitudes) {
  // github.com/IOES-Lab/dave, nortek_dvl500_300: four beams, 25 degrees, 0.3 to 200 m along a beam, 5 mm/s.
  std::string beams;
  for (const std::string rotation : {"-135", "135", "45", "-45"})
    beams += "<beam><aperture>3</aperture><rotation>" + rotation + "</rotation><tilt>25</tilt></beam>";
  const tools::RobotImport import = imported_sdf(sdf_text(
      sdf_link("a",
               "<sensor name=\"dvl\" type=\"custom\" gz:type=\"dvl\"><update_rate>8</update_rate><gz:dvl>"
               "<arrangement degrees=\"true\">" +
                   beams +
                   "</arrangement><tracking><bottom_mode><noise type=\"gaussian\"><stddev>0.005</stddev></noise>"
                   "</bottom_mode></tracking><maximum_range>200.</maximum_range><minimum_range>0.3</minimum_range>"
                   "</gz:dvl></sensor>")));
  const tools::ImportedDevice& dvl = device_of(import, "dvl");
  EXPECT_EQ(key_of(dvl.keys, "beam_angle_deg"), "25");
  EXPECT_EQ(key_of(dvl.keys, "first_azimuth_deg"), "-45");  // 180 + 135
  EXPECT_NEAR(std::stod(key_of(dvl.keys, "altitude_max_m")), 200 * std::cos(25 * M_PI / 180), 1e-6);
  EXPECT_EQ(key_of(dvl.keys, "beam_noise"), "{gaussian_std: 0.005}");
  EXPECT_EQ(notes_of(import.vehicle), "");
}

}  // namespace
