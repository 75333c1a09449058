// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "sim/world/world_checks.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using testing::HasSubstr;

/// What is warned of while a world is built.
std::string warnings_of_start(const std::string& yaml) {
  const test_support::LogCapture log;
  test::TestWorld built(yaml);
  return log.text();
}

/// Spheres of radius 1 m at these places; objects as they are given.
std::string spheres(const std::vector<std::string>& places, const std::string& objects, const std::string& entry = "") {
  std::string yaml = "shoal: 1\nobjects:\n" + objects + "vehicles:\n";
  for (std::size_t i = 0; i < places.size(); ++i)
    yaml += "  - {name: v" + std::to_string(i + 1) + ", position_m: " + places[i] + entry +
            ", model: {shoal: 1, vehicle: ball, bodies: [{name: hull, parts: [{shape: sphere, radius_m: 1, mass_kg: "
            "1}]}]}}\n";
  return yaml;
}

const std::string ground = "  - {name: ground, fixed: true, parts: [{shape: plane}]}\n";
const std::string rock = "  - {name: rock, fixed: true, parts: [{shape: box, size_m: [2, 2, 2]}]}\n";

TEST(StartCheck, ReportsAVehicleInAnObject) {
  // The sphere reaches from 1.7 to 3.7 m, the rock to 1 m on its side: 0.3 m of the first are in the second.
  EXPECT_EQ(warnings_of_start(spheres({"[1.7, 0, 0]"}, rock)),
            "worlds/test.yaml:5:5: vehicle 'v1': it starts 0.3 m deep in 'rock'\n");
}

TEST(StartCheck, ReportsAVehicleBelowTheGround) {
  EXPECT_EQ(warnings_of_start(spheres({"[0, 0, -5]"}, ground)),
            "worlds/test.yaml:5:5: vehicle 'v1': it starts 6 m deep in 'ground'\n");
}

TEST(StartCheck, IsSilentAboutWhatStandsOrIsAMillimeterDeep) {
  EXPECT_EQ(warnings_of_start(spheres({"[0, 0, 1]", "[0, 3, 0.999]", "[0, 6, 5]"}, ground)), "");
}

TEST(StartCheck, ReportsOnceOfTwoVehiclesInEachOther) {
  EXPECT_EQ(warnings_of_start(spheres({"[9, 0, 0]", "[9, 0, 1.5]"}, rock)),
            "worlds/test.yaml:5:5: vehicle 'v1': it starts 0.5 m deep in 'v2'\n");
}

TEST(StartCheck, ReportsAFreeObjectAndNotOfFixedOnes) {
  const std::string box = "parts: [{shape: box, mass_kg: 1}]}\n";
  const std::string crate = "  - {name: crate, position_m: [0, 0, 1.25], " + box;
  const std::string wall = "  - {name: wall, fixed: true, position_m: [0, 0, 0.5], " + box;
  EXPECT_EQ(warnings_of_start("shoal: 1\nobjects:\n" + rock + crate + wall),
            "worlds/test.yaml:4:5: object 'crate': it starts 0.25 m deep in 'rock'\n");
}

TEST(StartCheck, ReportsAVehicleBelowTerrain) {
  const std::string hills =
      "  - {name: hills, fixed: true, parts: [{shape: terrain, terrain: {source: slope, size_m: [100, 100], cell_m: "
      "1}}]}\n";
  EXPECT_THAT(warnings_of_start(spheres({"[0, 0, -40]"}, hills)),
              HasSubstr("vehicle 'v1': it starts below the terrain of 'hills'"));
  EXPECT_EQ(warnings_of_start(spheres({"[0, 0, 1]"}, hills)), "");
}

TEST(StartCheck, CountsTheOthersOfAnEntry) {
  EXPECT_EQ(warnings_of_start(spheres({"[0, 0, 0]"}, ground, ", count: 5, placement: {pattern: line, spacing_m: 10}")),
            "worlds/test.yaml:5:5: vehicle 'v11': it starts 1 m deep in 'ground' (and 4 more of this entry)\n");
}

TEST(StartCheck, ReportsAWheelInTheGround) {
  const std::string rover = test::rover_world("        []\n", "", "    position_m: [0, 0, -0.03]\n");
  EXPECT_THAT(warnings_of_start(rover), HasSubstr("vehicle 'r1': it starts 0.03 m deep in 'ground'"));
}

TEST(StartCheck, ReportsACraftInTheAir) {
  const auto warnings = [](double height_m, const std::string& more = "") {
    return warnings_of_start("shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {surface_m: 1}}\n" + more +
                             "vehicles: [{name: auv, file: remus100.yaml, position_m: [0, 0, " +
                             std::to_string(height_m) + "]}]\n");
  };
  // The hull's radius is 0.095 m: 16 - 0.095 - 1 = 14.905 m.
  EXPECT_THAT(warnings(16), HasSubstr("vehicle 'auv': it starts 14.91 m above the water, and falls"));
  EXPECT_EQ(warnings(1.1), "");
  EXPECT_EQ(warnings(-10), "");
  const std::string deck =
      "objects: [{name: deck, fixed: true, position_m: [0, 0, 15], parts: [{shape: box, size_m: [9, 9, 1]}]}]\n";
  EXPECT_EQ(warnings(16, deck), "");
}

TEST(StartCheck, IsSilentAboutACraftOverTheTroughOfAWave) {
  // The hull begins 0.9 m above the trough.
  EXPECT_EQ(
      warnings_of_start("shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {}, waves: {type: regular, height_m: 2, "
                        "phase_deg: 180}}\nvehicles: [{name: auv, file: remus100.yaml}]\n"),
      "");
}

/// A restore that builds the world again says nothing again.
TEST(StartCheck, IsSilentWhenAWorldIsBuiltAgain) {
  const test_support::LogCapture log;
  test::TestWorld built(spheres({"[1.7, 0, 0]"}, rock));
  const std::string reported = log.text();
  const sim::Bytes start = built.world.state().snapshot();
  built.run_for(0.1);
  built.world.editor().remove_object("rock");
  built.world.state().restore(start);
  EXPECT_NE(built.world.find_object("rock"), nullptr);
  EXPECT_EQ(log.text(), reported);
}

}  // namespace
