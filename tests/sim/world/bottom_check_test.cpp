// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/bottom_check.hpp"

#include "tests/devices/world_fixture.hpp"

namespace {

/// How many warnings a craft gets that is in open water and carries these.
std::size_t warnings_with(const std::string& devices) {
  test::TestWorld test(R"(
shoal: 1
medium: {water: {}}
vehicles:
  - name: auv
    position_m: [0, 0, -2]
    model:
      shoal: 1
      vehicle: auv
      bodies: [{name: hull, parts: [{shape: sphere, radius_m: 0.1, density_kgpm3: 1025}]}]
      devices: [{name: push, type: body_wrench}, )" +
                       devices + "]\n");
  return sim::bottom_warnings(test.world).size();
}

TEST(BottomCheck, IsForCraftThatLookForTheBottom) {
  for (const std::string type : {"dvl", "altimeter", "sonar", "multibeam", "side_scan", "imaging_sonar"})
    EXPECT_EQ(warnings_with("{name: it, type: " + type + "}"), 1u) << type;
  for (const std::string type : {"gps", "imu", "pressure", "ctd", "water_speed", "ahrs"})
    EXPECT_EQ(warnings_with("{name: it, type: " + type + "}"), 0u) << type;
}

TEST(BottomCheck, IsForAutopilotsThatKeepAnAltitude) {
  const auto warnings = [](const std::string& keys) {
    return warnings_with(
        "{name: thruster, type: thruster, command: thrust_N, max: 20, min: -20}, "
        "{name: pilot, type: autopilot, thrusters: [thruster], " +
        keys + "}");
  };
  EXPECT_EQ(warnings("hold: {depth_m: 3}"), 0u);
  EXPECT_EQ(warnings("hold: {altitude_m: 3}"), 1u);
  EXPECT_EQ(warnings("waypoints: [{at_m: [10, 0], depth_m: 3}]"), 0u);
  EXPECT_EQ(warnings("waypoints: [{at_m: [10, 0], depth_m: 3}, {at_m: [20, 0], altitude_m: 3}]"), 1u);
  EXPECT_EQ(warnings("lawnmower: {corner_m: [0, 0], altitude_m: 5}"), 1u);
}

}  // namespace
