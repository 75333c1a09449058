// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/autopilot_config.hpp"

#include <gmock/gmock.h>

#include "tests/devices/autopilot/autopilot_world.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace autopilot_world;

TEST(Autopilot, SaysWhatIsWrongWithItsParameters) {
  const auto error = [](const std::string& file, const std::string& overrides) {
    return test::error_of_world(world_with(file, overrides));
  };
  using testing::HasSubstr;
  EXPECT_THAT(error("remus100_survey.yaml", "      devices.autopilot.fins: [rudder, plane]\n"),
              HasSubstr("device 'autopilot': 'fins' names no fin 'plane'"));
  EXPECT_THAT(error("remus100_survey.yaml", "      devices.autopilot.thrusters: [rudder]\n"),
              HasSubstr("device 'autopilot': 'thrusters' names no thruster 'rudder'"));
  EXPECT_THAT(error("otter_autopilot.yaml", "      devices.autopilot.axes: [surge, sway]\n"),
              HasSubstr("'axes': the thrusters cannot give sway in addition to the axes before it"));
  EXPECT_THAT(error("otter_autopilot.yaml", "      devices.autopilot.axes: [surge, jaw]\n"),
              HasSubstr("'axes' must be of surge, sway, heave, roll, pitch, yaw; got 'jaw'"));
  EXPECT_THAT(error("otter_autopilot.yaml", "      devices.autopilot.thruster_weights: [1]\n"),
              HasSubstr("'thruster_weights' must have one number for each thruster"));
  EXPECT_THAT(error("otter_autopilot.yaml", "      devices.autopilot.thrusters: [port, starboard, port]\n"),
              HasSubstr("'thrusters' names 'port' twice"));
  EXPECT_THAT(error("otter_autopilot.yaml", "      devices.autopilot.waypoints: [{at_m: [1, 2, 3]}]\n"),
              HasSubstr("'at_m' must be two numbers"));
  EXPECT_THAT(error("otter_autopilot.yaml", "      devices.autopilot.mode: waypoints\n"),
              HasSubstr("'mode' waypoints needs 'waypoints' or 'lawnmower'"));
  EXPECT_THAT(error("otter_autopilot.yaml",
                    "      devices.autopilot.thrusters: []\n      devices.autopilot.axes: []\n"
                    "      devices.autopilot.helm: gps\n"),
              HasSubstr("'helm' names no device 'gps' that takes shoal.helm_command_t"));
}

}  // namespace
