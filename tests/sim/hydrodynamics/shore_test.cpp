// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world_checks.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/sim/hydrodynamics/floating_worlds.hpp"

// Land, water and what goes from one to the other.

namespace {

using test::TestWorld;
using testing::HasSubstr;

/// A beach that falls away to the east: the water line is at x = 0.
const char* beach = R"(
shoal: 1
physics: {step_s: 0.005}
medium: {water: {}}
objects:
  - {name: beach, fixed: true, rpy_deg: [0, 15, 0], parts: [{shape: plane}]}
)";

TEST(Shore, ABoxThatSlidesIntoTheSeaFloatsAndAStoneStaysBelow) {
  TestWorld test(
      std::string("shoal: 1\nphysics: {step_s: 0.005}\nmedium: {water: {}}\n"
                  "contacts: [{between: [any, any], friction: 0}]\n"
                  "objects:\n  - {name: bottom, fixed: true, position_m: [0, 0, -2], parts: [{shape: plane}]}\n"
                  "  - {name: raft, position_m: [0, 0, 1], parts: [{shape: box, size_m: [1, 1, 0.4], "
                  "density_kgpm3: 400}]}\n"
                  "  - {name: stone, position_m: [5, 0, 1], parts: [{shape: box, size_m: [1, 1, 0.4], "
                  "density_kgpm3: 2600}]}\n"));
  test.run_for(30);
  EXPECT_NEAR(test.world.find_object("raft")->base().X_WB().translation().z(), 0.2 - 0.4 * 400 / 1025, 0.02);
  EXPECT_NEAR(test.world.find_object("stone")->base().X_WB().translation().z(), -1.8, 0.002);
}

TEST(Shore, WaterFarBelowChangesNoBitOfALandVehicle) {
  const auto pose_after = [](const char* water) {
    TestWorld test(std::string("shoal: 1\n") + water +
                   "objects:\n  - {name: ground, fixed: true, parts: [{shape: plane}]}\n"
                   "  - {name: it, position_m: [0, 0, 1], rpy_deg: [10, 20, 30], parts: [{shape: box, mass_kg: 3}]}\n");
    test.run_for(5);
    return test.world.find_object("it")->base().X_WB().matrix().eval();
  };
  EXPECT_EQ(pose_after(""), pose_after("medium: {water: {surface_m: -3}}\n"));
}

TEST(Shore, SaysWhereThereIsNoBottom) {
  const char* auv = R"(
vehicles:
  - name: auv1
    position_m: [X, 0, -1]
    model:
      shoal: 1
      vehicle: auv
      bodies: [{name: hull, parts: [{shape: sphere, radius_m: 0.1, density_kgpm3: 1025}]}]
      devices: [{name: altimeter, type: altimeter}]
)";
  const auto warnings_at = [&](const std::string& x) {
    std::string yaml = beach;
    yaml += auv;
    yaml.replace(yaml.find("X, 0"), 1, x);
    TestWorld test(yaml);
    return sim::bottom_warnings(test.world);
  };
  EXPECT_TRUE(warnings_at("20").empty());
  std::string without_beach = "shoal: 1\nmedium: {water: {}}\n";
  without_beach += auv;
  TestWorld open(without_beach.replace(without_beach.find("X, 0"), 1, "0"));
  const auto warnings = sim::bottom_warnings(open.world);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "there is no bottom below vehicle 'auv1': downward-looking sensors there detect nothing");
}

TEST(Shore, SaysNothingOfTheBottomForWhatLooksAroundAboveTheWater) {
  const auto warnings_at = [](const std::string& height_m) {
    TestWorld test(
        "shoal: 1\nmedium: {water: {}}\n"
        "vehicles:\n  - name: boat\n    position_m: [0, 0, -0.1]\n    model:\n      shoal: 1\n      vehicle: boat\n"
        "      bodies: [{name: hull, parts: [{shape: box, size_m: [2, 1, 0.4], density_kgpm3: 500}]}]\n"
        "      devices: [{name: lidar, type: lidar, position_m: [0, 0, " +
        height_m + "]}]\n");
    return sim::bottom_warnings(test.world).size();
  };
  EXPECT_EQ(warnings_at("1.5"), 0u);
  EXPECT_EQ(warnings_at("-0.3"), 1u);
}

TEST(Shore, SaysThatThereIsNoBottomBelowANewcomerToo) {
  TestWorld test(
      "shoal: 1\nmedium: {water: {}}\n"
      "vehicles:\n  - name: auv1\n    position_m: [0, 0, -1]\n    model:\n      shoal: 1\n      vehicle: auv\n"
      "      bodies: [{name: hull, parts: [{shape: sphere, radius_m: 0.1, density_kgpm3: 1025}]}]\n"
      "      devices: [{name: altimeter, type: altimeter}]\n");
  sim::VehicleInstance instance = test.loaded.config.vehicles[0];
  instance.name = "auv2";
  instance.X_WV.translation().x() = 5;
  testing::internal::CaptureStdout();
  test.world.editor().add_vehicle(instance);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("there is no bottom below vehicle 'auv2': downward-looking sensors there detect nothing"));
  ASSERT_EQ(sim::bottom_warnings(test.world).size(), 1u);
  EXPECT_THAT(sim::bottom_warnings(test.world)[0], HasSubstr("'auv1' (nor below 1 more)"));
}

TEST(Shore, ASecondRunOfFloatingBodiesGivesTheSameBits) {
  const auto hash_after = [] {
    TestWorld test(
        "shoal: 1\nphysics: {step_s: 0.01}\n"
        "medium: {water: {}, waves: {type: jonswap, hs_m: 0.5, tp_s: 4}, current: [{velocity_mps: [0.3, 0, "
        "0]}]}\nobjects:\n"
        "  - {name: raft, count: 5, parts: [{shape: box, size_m: [1, 1, 0.4], density_kgpm3: 400}], "
        "placement: {pattern: grid, spacing_m: 3}}\n"
        "  - {name: spar, position_m: [-5, 0, 0], parts: [{shape: capsule, radius_m: 0.1, length_m: 1, "
        "density_kgpm3: 600, added_mass_coefficient: 0.5}]}\n");
    test.run_for(10);
    return test.world.state().hash();
  };
  EXPECT_EQ(hash_after(), hash_after());
}

}  // namespace
