// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_checks.hpp"

#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using testing::HasSubstr;

/// Water with its surface at 2 m, and these objects.
std::string fault_at(const std::string& objects, double depth_m, const Eigen::Vector2d& p_W = {0, 0}) {
  test::TestWorld test("shoal: 1\nmedium: {water: {surface_m: 2}}\nobjects: [" + objects + "]\n");
  return sim::depth_fault(test.world, p_W, depth_m);
}

const std::string plane_at_40_m = "{name: bottom, fixed: true, position_m: [0, 0, -38], parts: [{shape: plane}]}";

TEST(PlanCheck, ADepthBelowZeroIsInTheAir) {
  EXPECT_EQ(fault_at("", -15), "depth -15 m is in the air: depths are positive downwards");
  EXPECT_EQ(fault_at("", 0), "");
  EXPECT_EQ(fault_at("", 15), "");
}

TEST(PlanCheck, FindsAPlaceBelowAPlane) {
  EXPECT_EQ(fault_at(plane_at_40_m, 55), "depth 55 m is below the bottom, which is at 40 m there");
  EXPECT_EQ(fault_at(plane_at_40_m, 39.9), "");
}

TEST(PlanCheck, FindsAPlaceBelowTerrainAtItsOwnHeight) {
  // A slope of 10 deg through (0, 0, -20).
  const std::string slope =
      "{name: bottom, fixed: true, position_m: [0, 0, -20], parts: [{shape: terrain, terrain: {source: slope, "
      "angle_deg: 10, size_m: [100, 100], cell_m: 1}}]}";
  EXPECT_EQ(fault_at(slope, 21.9), "");
  EXPECT_THAT(fault_at(slope, 22.1), HasSubstr("which is at 22 m there"));
}

TEST(PlanCheck, FindsAPlaceInASolidAndNotUnderAPierOrAShip) {
  const auto box = [](const std::string& keys, double height_m) {
    return "{name: box, " + keys + ", position_m: [0, 0, " + std::to_string(height_m) +
           "], parts: [{shape: box, size_m: [10, 10, 4], mass_kg: 1}]}";
  };
  EXPECT_EQ(fault_at(box("fixed: true", -20), 21), "depth 21 m is below the bottom, which is at 20 m there");
  EXPECT_EQ(fault_at(box("fixed: true", -20), 21, {6, 0}), "");
  EXPECT_EQ(fault_at(box("fixed: true", 0) + ", " + plane_at_40_m, 21), "");
  EXPECT_EQ(fault_at(box("fixed: false", -20), 21), "");
}

/// What `check` says of an AUV at 10 m with these keys of its autopilot, over a plane at 40 m.
std::string warnings_of_autopilot(const std::string& keys) {
  const test_support::LogCapture log;
  test::TestWorld test(
      "shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {surface_m: 2}}\nobjects: [" + plane_at_40_m +
      "]\nvehicles:\n  - name: v\n    file: remus100_survey.yaml\n    position_m: [0, 0, -8]\n    overrides:\n      " +
      keys + "\n");
  return log.text();
}

TEST(PlanCheck, WarnsOfTheDepthsOfAnAutopilot) {
  const auto lawnmower = [](const std::string& depth) {
    return "devices.autopilot.lawnmower: {corner_m: [0, 0], length_m: 50, width_m: 20, spacing_m: 10, speed_mps: 1.5" +
           depth + "}";
  };
  EXPECT_EQ(warnings_of_autopilot(lawnmower(", depth_m: 15")), "");
  EXPECT_EQ(warnings_of_autopilot(lawnmower(", altitude_m: 5")), "");
  // Once, and not for each of the six points.
  EXPECT_EQ(
      warnings_of_autopilot(lawnmower(", depth_m: -15")),
      "worlds/test.yaml:10:36: vehicle 'v': device 'autopilot': 'lawnmower': depth -15 m is in the air: depths are "
      "positive downwards\n");
  EXPECT_THAT(warnings_of_autopilot(lawnmower(", depth_m: 55")),
              HasSubstr("'lawnmower': depth 55 m is below the bottom, which is at 40 m there"));
  EXPECT_THAT(warnings_of_autopilot("devices.autopilot.hold: {depth_m: -15}"),
              HasSubstr("'hold': depth -15 m is in the air"));
  EXPECT_THAT(warnings_of_autopilot("devices.autopilot.waypoints: [{at_m: [5, 0], speed_mps: 1, depth_m: 55}]"),
              HasSubstr("'waypoints': depth 55 m"));
}

TEST(PlanCheck, WarnsOfARouteThatBeginsWithoutASpeed) {
  const std::string stands = "begins without a speed: the vehicle stands still until a command gives one";
  EXPECT_THAT(warnings_of_autopilot("devices.autopilot.waypoints: [{at_m: [5, 0]}, {at_m: [9, 0], speed_mps: 1}]"),
              HasSubstr("'waypoints' " + stands));
  EXPECT_THAT(warnings_of_autopilot("devices.autopilot.lawnmower: {corner_m: [0, 0], altitude_m: 5}"),
              HasSubstr("'lawnmower' " + stands));
  EXPECT_EQ(warnings_of_autopilot(
                "devices.autopilot.hold: {speed_mps: 1}\n      devices.autopilot.waypoints: [{at_m: [5, 0]}]"),
            "");
}

}  // namespace
