// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/tools/shoal/sdf/sdf_texts.hpp"

namespace {

using namespace test;
using testing::HasSubstr;

std::string water_plugin(const std::string& content) {
  return sdf_plugin("Hydrodynamics", "<link_name>a</link_name>" + content);
}

tools::RobotImport in_water(const std::string& content, const std::string& more = sdf_box("2 1 0.5")) {
  return imported_sdf(sdf_text(sdf_link("a", more) + water_plugin(content)));
}

std::string water_key(const tools::RobotImport& import, const std::string& key) {
  return key_of(import.vehicle.bodies.at(0).water, key);
}

TEST(SdfWater, TakesNegativeDerivativesAsMassAndDamping) {
  // Gazebo: xDotU -5 is 5 kg of added mass, xU -4 and xUabsU -18 are damping.
  const tools::RobotImport import =
      in_water("<xDotU>-5</xDotU><yDotV>-6</yDotV><nDotR>-0.5</nDotR><xU>-4</xU><nR>-0.1</nR><xUabsU>-18</xUabsU>");
  EXPECT_EQ(water_key(import, "added_mass"), "[5, 6, 0, 0, 0, 0.5]");
  EXPECT_EQ(water_key(import, "linear_damping"), "[4, 0, 0, 0, 0, 0.1]");
  EXPECT_EQ(water_key(import, "quadratic_damping"), "[18, 0, 0, 0, 0, 0]");
  EXPECT_EQ(water_key(import, "quirks"), "");
  EXPECT_EQ(notes_of(import.vehicle), "");
}

TEST(SdfWater, DisplacesTheVolumeOfTheCollisions) {
  const tools::RobotImport import =
      in_water("<xU>-1</xU>",
               "<collision name=\"c\"><pose>0 0 0.25 0 0 0</pose><geometry><box><size>2 1 0.5</size></box>"
               "</geometry></collision>");
  EXPECT_EQ(water_key(import, "volume_m3"), "1");
  EXPECT_EQ(water_key(import, "center_of_buoyancy_m"), "[0, 0, 0.25]");
  EXPECT_EQ(water_key(import, "hull_height_m"), "0.5");
}

TEST(SdfWater, KeepsAllTermsOfTheMatrices) {
  const tools::RobotImport import = in_water(
      "<yDotV>-4</yDotV><nDotR>-4</nDotR><yDotR>-1</yDotR><nDotV>-1</nDotV><yR>150</yR><xVabsR>3</xVabsR>"
      "<yUV>-28.6</yUV><zWabsQ>-2</zWabsQ>");
  EXPECT_EQ(
      water_key(import, "added_mass"),
      "[0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 4]");
  EXPECT_EQ(water_key(import, "derivatives"), "{X_v|r|: 3, Y_r: 150, Y_uv: -28.6, Z_w|q|: -2}");
}

TEST(SdfWater, TellsOldSignsAndSwitches) {
  const tools::RobotImport old = in_water("<xDotU>5</xDotU><zDotW>7</zDotW>");
  EXPECT_EQ(water_key(old, "added_mass"), "[5, 0, 7, 0, 0, 0]");
  EXPECT_THAT(notes_of(old.vehicle), HasSubstr("its positive added mass is taken as mass, as in Gazebo before 6.12"));
  EXPECT_EQ(water_key(in_water("<xDotU>-5</xDotU><disable_coriolis>true</disable_coriolis>"), "quirks"),
            "{added_mass_coriolis: none}");
  EXPECT_EQ(water_key(in_water("<xDotU>-5</xDotU><disable_added_mass>true</disable_added_mass>"), "added_mass"), "");
  const tools::RobotImport pushed = in_water("<xU>4</xU><xUU>-3</xUU>");
  EXPECT_EQ(water_key(pushed, "linear_damping"), "");
  EXPECT_EQ(water_key(pushed, "quadratic_damping"), "[3, 0, 0, 0, 0, 0]");
  EXPECT_THAT(notes_of(pushed.vehicle), HasSubstr("<xU> is not imported: with this sign it would push the vehicle on"));
  EXPECT_THAT(notes_of(pushed.vehicle), HasSubstr("<xUU> is taken as <xUabsU>"));
}

TEST(SdfWater, CorrectsAnAddedMassThatIsNone) {
  const tools::RobotImport import = in_water("<xDotU>-1</xDotU><yDotV>-1</yDotV><xDotV>-4</xDotV>");
  EXPECT_EQ(water_key(import, "added_mass"), "[1, 1, 0, 0, 0, 0]");
  EXPECT_THAT(notes_of(import.vehicle), HasSubstr("is not symmetric"));
  EXPECT_THAT(notes_of(import.vehicle), HasSubstr("is not positive semi-definite"));
}

TEST(SdfWater, AddsTheAddedMassOfALink) {
  const tools::RobotImport import = imported_sdf(
      sdf_text("<link name=\"a\"><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia>"
               "<fluid_added_mass><xx>3</xx><yy>4</yy><rr>5</rr></fluid_added_mass></inertial></link>\n"));
  EXPECT_EQ(water_key(import, "added_mass"), "[3, 4, 0, 0, 0, 5]");
}

TEST(SdfWater, ReadsTheModelOfUuvSimulatorInItsAxes) {
  // Forward-right-down: what couples u and w changes its sign, what couples v and w does not.
  const std::string zeros = " 0 0 0 0 0 0";
  const tools::RobotImport import = imported_sdf(sdf_text(
      sdf_link("a") +
      "<plugin name=\"uuv_plugin\" filename=\"libuuv_underwater_object_ros_plugin.so\"><link name=\"a\">"
      "<volume>2</volume><box><height>1.6</height></box><center_of_buoyancy>0 0 0.3</center_of_buoyancy>"
      "<hydrodynamic_model><type>fossen</type><added_mass>8 0 -1 0 0 0 0 8 2 0 0 0 -1 2 8 0 0 0" +
      zeros + zeros + zeros +
      "</added_mass><linear_damping>-74 -69 -728 -268 -309 -105</linear_damping>"
      "<quadratic_damping>-748 -992 -1821 -672 -774 -523</quadratic_damping></hydrodynamic_model></link></plugin>\n"));
  EXPECT_THAT(water_key(import, "added_mass"), HasSubstr("[8, 0, 1, 0, 0, 0, 0, 8, 2, 0, 0, 0, 1, 2, 8, 0"));
  EXPECT_EQ(water_key(import, "linear_damping"), "[74, 69, 728, 268, 309, 105]");
  EXPECT_EQ(water_key(import, "quadratic_damping"), "[748, 992, 1821, 672, 774, 523]");
  EXPECT_EQ(water_key(import, "volume_m3"), "2");
  EXPECT_EQ(water_key(import, "center_of_buoyancy_m"), "[0, 0, 0.3]");
  EXPECT_EQ(water_key(import, "hull_height_m"), "1.6");
}

TEST(SdfWater, MakesTheLinkOfTheCoefficientsTheFrameOfItsBody) {
  const tools::RobotImport import = imported_sdf(sdf_text(sdf_link("b") + sdf_link("a", "<pose>1 0 0 0 0 0</pose>") +
                                                          sdf_joint("fixed", "", "<parent>b</parent><child>a</child>") +
                                                          water_plugin("<xU>-4</xU>")));
  ASSERT_EQ(import.vehicle.bodies.size(), 1u);
  EXPECT_EQ(import.vehicle.bodies[0].name, "a");
  EXPECT_TRUE(import.vehicle.bodies[0].X_VB.translation().isApprox(sim::Vector3d(1, 0, 0)));
  EXPECT_EQ(water_key(import, "linear_damping"), "[4, 0, 0, 0, 0, 0]");
  EXPECT_THAT(notes_of(imported_sdf(sdf_text(sdf_link("b") + water_plugin("<xU>-4</xU>"))).vehicle),
              HasSubstr("the coefficients of link 'a' are not imported: there is no such link"));
}

}  // namespace
