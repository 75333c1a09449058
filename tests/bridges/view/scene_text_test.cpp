// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "bridges/view/view_publisher.hpp"
#include "sim/world/world_state.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/view/viewed_world.hpp"
#include "tests/devices/comms/modem_fixture.hpp"

namespace {

using namespace viewed_world;

TEST(ViewPublisher, TheSceneHasEveryBodyInTheOrderOfItsNumber) {
  ViewedWorld viewed(rover_and_ball);
  const Json scene = viewed.last_scene();
  ASSERT_EQ(scene["bodies"].size(), 5u);  // ground, ball, chassis and two wheels
  for (std::size_t i = 1; i < scene["bodies"].size(); ++i)
    EXPECT_LT(scene["bodies"][i - 1]["id"], scene["bodies"][i]["id"]);
  const auto of = [&](const std::string& name) {
    for (const Json& body : scene["bodies"])
      if (body["name"] == name) return body;
    return Json();
  };
  EXPECT_EQ(of("r1/chassis")["parts"].size(), 3u);
  EXPECT_EQ(of("r1/chassis")["parts"][0]["size_m"], Json({0.4, 0.3, 0.1}));
  EXPECT_EQ(of("r1/chassis")["owner"], "r1");
  const Json& lidar = scene["vehicles"][0]["devices"][0];
  EXPECT_EQ(lidar["type"], "lidar");
  EXPECT_EQ(lidar["channels"], Json({"r1.lidar"}));
  EXPECT_EQ(lidar["field_of_view"]["range_m"], 8);
  EXPECT_EQ(lidar["field_of_view"]["range_min_m"], 0.05);
  EXPECT_NEAR(lidar["field_of_view"]["to_rad"].get<double>(), 0.7854, 1e-3);
}

TEST(ViewPublisher, TheSceneSaysWhichPartsCollideWithNothing) {
  const std::string lamp = "{shape: sphere, radius_m: 0.1, category: light, collides_with: [light]}";
  const std::string post = "[{shape: box}, {shape: box, category: light}, " + lamp + "]";
  const std::string world =
      "shoal: 1\ncategories: [light]\nobjects:\n  - {name: one, fixed: true, parts: " + post + "}\n";
  const auto collide = [](const Json& scene) {
    std::vector<bool> all;
    for (const Json& part : scene["bodies"][0]["parts"]) all.push_back(part.value("collides", true));
    return all;
  };
  // A lamp collides with lamps of others only.
  const Json alone = ViewedWorld(world).last_scene();
  EXPECT_EQ(collide(alone), (std::vector<bool>{true, true, false}));
  EXPECT_FALSE(alone["bodies"][0]["parts"][0].contains("collides"));
  const Json two =
      ViewedWorld(world + "  - {name: two, fixed: true, position_m: [9, 0, 0], parts: [" + lamp + "]}\n").last_scene();
  EXPECT_EQ(collide(two), (std::vector<bool>{true, true, true}));
}

TEST(ViewPublisher, TheSceneHasTheRangesOfADeviceAfterAChange) {
  ViewedWorld viewed(rover_and_ball);
  viewed.run_for(1);
  EXPECT_EQ(viewed.test.change("r1/lidar", "{range_max_m: 5}"), "");
  viewed.run_for(0.1);
  EXPECT_EQ(viewed.last_scene()["vehicles"][0]["devices"][0]["field_of_view"]["range_m"], 5);
}

TEST(ViewPublisher, TheSceneSaysWhichVehiclesHaveTheirOwnClock) {
  ViewedWorld viewed(test::modem_sea({{"a", "[0, 0, -5]", "", "clock: {offset_s: 1}"}, {"b", "[9, 0, -5]", "", ""}}));
  const Json vehicles = viewed.last_scene()["vehicles"];
  ASSERT_EQ(vehicles.size(), 2u);
  EXPECT_EQ(vehicles[0]["own_clock"], true);
  EXPECT_EQ(vehicles[1]["own_clock"], false);
}

TEST(ViewPublisher, VehiclesHaveTheColorsOfFilmsAndPlots) {
  ViewedWorld viewed(test::modem_sea({{"a", "[0, 0, -5]", "", ""}, {"b", "[9, 0, -5]", "", ""}}));
  const Json vehicles = viewed.last_scene()["vehicles"];
  ASSERT_EQ(vehicles.size(), 2u);
  EXPECT_EQ(vehicles[0]["color"], "#56b4e9");
  EXPECT_EQ(vehicles[1]["color"], "#e69f00");
}

using namespace viewed_world;

/// A world with every kind of current, except grids.
const std::string many_currents = R"(shoal: 1
physics: {step_s: 0.01}
medium:
  water: {surface_m: 1}
  current:
    - {velocity_mps: [0.2, 0.1, 0]}
    - {type: power_law, speed_mps: 0.5, direction_deg: 90, water_depth_m: 40}
    - {type: vortex, center_m: [40, 30], peak_speed_mps: 0.3, core_radius_m: 10, core: rankine}
    - {type: profile, profile: [{depth_m: 0, velocity_mps: [0.1, 0, 0]}, {depth_m: 10, velocity_mps: [0, 0.1, 0]}]}
)";

TEST(ViewPublisher, TheSceneHasCurrentsAndTides) {
  ViewedWorld viewed(many_currents + "  tides: [{amplitude_m: 0.5, period_s: 600, phase_deg: 90, current_mps: 0.4}]\n");
  const Json water = viewed.last_scene()["water"];
  EXPECT_EQ(water["mean_level_m"], 1);
  EXPECT_NEAR(water["tides"][0]["phase_rad"].get<double>(), 1.5708, 1e-4);
  EXPECT_EQ(water["tides"][0]["current_mps"], 0.4);
  EXPECT_NEAR(water["sound_speed"][0][1].get<double>(), 1490, 5);  // of the water at the surface, not of the air
  ASSERT_EQ(water["currents"].size(), 4u);
  EXPECT_EQ(water["currents"][0]["velocity_mps"], Json({0.2, 0.1, 0.0}));
  EXPECT_EQ(water["currents"][1]["water_depth_m"], 40);
  EXPECT_EQ(water["currents"][2]["core"], "rankine");
  EXPECT_EQ(water["currents"][3]["rows"][1], Json({10.0, 0.0, 0.1, 0.0}));
  viewed.run_for(2);
  EXPECT_TRUE(viewed.currents.take_all().empty());  // the scene has all of it
}

TEST(ViewPublisher, ARandomCurrentIsPublishedOncePerSecond) {
  ViewedWorld viewed(many_currents +
                     "    - {type: gauss_markov, speed_mps: 0.3, std_mps: 0.1, correlation_time_s: 5}\n");
  viewed.run_for(3);
  const std::vector<shoal::sim_current_t> currents = viewed.currents.take_all();
  ASSERT_EQ(currents.size(), 4u);
  EXPECT_NE(currents[3].velocity_mps[0], currents[2].velocity_mps[0]);
  // Below the profile, the power law and far from the vortex only the uniform part is left.
  const sim::Vector3d v_W = viewed.test.world.medium().water_velocity_W({1e6, 1e6, -50});
  EXPECT_NEAR(currents[3].velocity_mps[0], v_W.x(), 1e-5);
  EXPECT_NEAR(currents[3].velocity_mps[1] + 0.1, v_W.y(), 1e-5);
  EXPECT_EQ(currents[3].step, 300);
}

TEST(ViewPublisher, AGridOfCurrentsHasItsPoints) {
  const lcm_test::ScratchFolder folder;
  const std::string file = folder.file("grid.csv");
  std::ofstream(file) << "x_m,y_m,east_mps,north_mps\n0,0,0.1,0.2\n10,0,0.3,0.4\n0,5,0.5,0.6\n10,5,0.7,0.8\n";
  ViewedWorld viewed("shoal: 1\nmedium: {water: {}, current: [{type: grid, file: " + file +
                     ", outside: edge, map_origin_m: [5, 0]}]}\n");
  const Json grid = viewed.last_scene()["water"]["currents"][0];
  EXPECT_EQ(grid["low_m"], Json({-5.0, 0.0}));
  EXPECT_EQ(grid["high_m"], Json({5.0, 5.0}));
  EXPECT_EQ(grid["columns"], 2);
  EXPECT_EQ(grid["outside"], "edge");
  ASSERT_EQ(grid["velocities_mps"].size(), 4u);
  EXPECT_NEAR(grid["velocities_mps"][1][0].get<double>(), 0.3, 1e-12);
  EXPECT_NEAR(grid["velocities_mps"][3][1].get<double>(), 0.8, 1e-12);
}

}  // namespace
