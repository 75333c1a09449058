// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/level_check.hpp"

#include <gmock/gmock.h>

#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/autopilot/autopilot_world.hpp"

namespace {

using namespace autopilot_world;

std::vector<std::string> level_lines(const std::string& overrides, bool warnings) {
  AutopilotWorld test(world_with("bluerov2_station.yaml", overrides));
  sim::Warnings& building = test.world.warnings().building();
  return warnings ? building.lines() : building.notes();
}

TEST(Autopilot, SaysUpToWhichSpeedItsGainsOutweighTheMunkMoment) {
  using testing::ElementsAre;
  using testing::HasSubstr;
  using testing::IsEmpty;
  // (w^2 (I + A) + W BG) / (Az - Ax) = (25 x 0.365 + 1.347) / 12.32 ahead, (25 x 0.449 + 1.347) / 11.56 aside.
  const std::string reported = "vehicle 'v': device 'autopilot': it holds the vehicle level up to ";
  EXPECT_THAT(
      level_lines("      devices.autopilot.mode: hold\n", false),
      ElementsAre(HasSubstr(reported + "0.92 m/s ahead and 1.04 m/s to the side; the thrusters reach 0.85 m/s and")));
  EXPECT_THAT(level_lines("      devices.autopilot.mode: hold\n", true), Not(testing::Contains(HasSubstr("level"))));
  // With 1.2 rad/s: (0.526 + 1.347) / 12.32, and the gain needed at 0.847 m/s is 4.53.
  EXPECT_THAT(level_lines("      devices.autopilot.gains.attitude.bandwidth_radps: 1.2\n", true),
              testing::Contains(AllOf(HasSubstr(reported + "0.39 m/s ahead"),
                                      HasSubstr("unless 'gains: attitude: bandwidth_radps' is above 4.53"))));
  EXPECT_THAT(level_lines("      devices.autopilot.axes: [surge, sway, heave, yaw]\n", true),
              testing::Contains(HasSubstr("the thrusters do not control its tilt")));
}

TEST(Autopilot, TurnsOverWhereItsGainsLoseToTheMunkMoment) {
  // The gains that are said to be enough below 0.39 m/s.
  const auto tilt_at = [](double speed_mps) {
    AutopilotWorld test(world_with("bluerov2_station.yaml",
                                   "      devices.autopilot.gains.attitude.bandwidth_radps: 1.2\n"
                                   "      devices.autopilot.mode: hold\n",
                                   "{water: {}}", -50));
    test.run_for(1);
    test.helm(speed_mps, 0, 50);
    double tilt = 0;
    for (int i = 0; i < 120; ++i) {
      test.run_for(1);
      tilt = std::max(tilt, tilt_deg(test));
    }
    return tilt;
  };
  EXPECT_LT(tilt_at(0.37), 5);
  // The estimate of the disturbance and a heave that gives way hold some more than the closed form.
  EXPECT_GT(tilt_at(0.5), 20);
}

}  // namespace
