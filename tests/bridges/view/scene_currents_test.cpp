// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "bridges/view/view_publisher.hpp"
#include "sim/world/world_state.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/view/viewed_world.hpp"

namespace {

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
