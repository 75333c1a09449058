// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "bridges/view/view_publisher.hpp"
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

}  // namespace
